/* SPDX-License-Identifier: MIT */
/*
 * Certificates of many answers, for test_check.py: write_certificates COUNT FIRST STRIDE. Cases FIRST, FIRST + STRIDE,
 * ... below COUNT are written to standard output, each as a line
 *
 *     P-points Q-points bytes claim-is-a-sum state distance, x y z w of the quaternion, x y z of the translation
 *
 * then the points of both models, a line each, then the certificate. Doubles are written with all their digits.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include <pirouette/certificate.h>

#include "support/bodies.h"

static void need(bool done, const char *what, unsigned long number) {
    if (done)
        return;
    fprintf(stderr, "write_certificates: case %lu: %s\n", number, what);
    exit(1);
}

static void write_points(const test_points *points) {
    for (size_t i = 0; i < points->count; i++)
        printf("%.17g %.17g %.17g\n", points->at[i].x, points->at[i].y, points->at[i].z);
}

/* Bodies at the ends of the range of doubles, by a power of two for both. */
static void make_extreme(test_random *random, test_pose *pose) {
    double scale = ldexp(1, test_random_between(random, 0, 1) ? 300 : -300);
    for (int body = 0; body < 2; body++) {
        test_points *points = body ? &pose->q : &pose->p;
        for (size_t i = 0; i < points->count; i++) {
            pir_vec3 *v = &points->at[i];
            *v = (pir_vec3){v->x * scale, v->y * scale, v->z * scale};
        }
    }
}

static pir_vec3 middle_of(const pir_polytope *polytope) {
    pir_vec3 low, high;
    pir_polytope_bounds(polytope, &low, &high);
    return (pir_vec3){low.x / 2 + high.x / 2, low.y / 2 + high.y / 2, low.z / 2 + high.z / 2};
}

/*
 * A translation: onto a vertex of the difference, between two, or of three, or off all by some of the bodies' size.
 * Vertices are taken of the sum's mesh, in doubles: of integers these are exact, so that bodies touch.
 */
static pir_vec3 random_translation(test_random *random, pir_sum *sum, unsigned long number) {
    pir_mesh *mesh = NULL;
    need(pir_sum_mesh(sum, PIR_DOUBLE, &mesh) == PIR_OK, "no mesh", number);
    const pir_vec3 *v = pir_mesh_vertices(mesh);
    uint32_t count = pir_mesh_vertex_count(mesh);
    pir_vec3 a = v[test_random_below(random, count)], b = v[test_random_below(random, count)];
    pir_vec3 c = v[test_random_below(random, count)], t = a;
    uint32_t kind = test_random_below(random, 6);
    pir_vec3 m = middle_of(pir_sum_q(sum));
    if (kind == 1)
        t = (pir_vec3){a.x / 2 + b.x / 2, a.y / 2 + b.y / 2, a.z / 2 + b.z / 2};
    else if (kind == 2)
        t = (pir_vec3){a.x / 4 + b.x / 4 + c.x / 2, a.y / 4 + b.y / 4 + c.y / 2, a.z / 4 + b.z / 4 + c.z / 2};
    else if (kind > 2) {
        double by = kind == 3 ? 0.5 : kind == 4 ? 1.25 : 1 + 0x1p-50;
        t = (pir_vec3){m.x + (a.x - m.x) * by, m.y + (a.y - m.y) * by, m.z + (a.z - m.z) * by};
    }
    pir_mesh_destroy(mesh);
    return t;
}

static void write_case(const test_pose *pose, pir_vec3 t, bool is_sum, const pir_query_result *answer,
                       pir_certificate *certificate) {
    size_t length;
    const char *text = pir_certificate_text(certificate, &length);
    const pir_quat q = pose->rotation;
    printf("%zu %zu %zu %d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", pose->p.count, pose->q.count, length,
           is_sum, (int)answer->state, answer->distance, q.x, q.y, q.z, q.w, t.x, t.y, t.z);
    write_points(&pose->p);
    write_points(&pose->q);
    fwrite(text, 1, length, stdout);
    pir_certificate_destroy(certificate);
}

/* One case: of the numbers that eight divides the sum or the difference, else an answer. */
static void run_case(unsigned long number) {
    test_random random = test_random_case("certificates", number);
    test_pose pose;
    test_random_pose(&random, 4 + test_random_below(&random, 8), &pose);
    if (test_random_below(&random, 8) == 0)
        make_extreme(&random, &pose);
    pir_polytope *p = test_polytope(&pose.p), *q = test_polytope(&pose.q);
    pir_sum_options options = pir_sum_options_default();
    options.difference = number % 16 != 0;
    pir_sum *sum = NULL;
    pir_query *query = NULL;
    pir_query_input input = pir_query_input_default();
    pir_query_result answer = {0};
    pir_certificate *certificate = NULL;
    need(pir_sum_create(p, q, pose.rotation, &options, &sum) == PIR_OK, "no sum", number);
    bool is_sum = number % 8 == 0;
    if (is_sum) {
        pir_status status = pir_sum_certificate(sum, &certificate);
        is_sum = status == PIR_OK;
        need(is_sum || status == PIR_ERR_ARGUMENT, "no certificate of the sum", number);
    } else {
        input.translation = random_translation(&random, sum, number);
        pir_proven proven = number % 3 == 0 ? PIR_PROVEN_STATE : PIR_PROVEN_NUMBER;
        pir_status status = pir_query_create(sum, &query);
        if (status == PIR_OK)
            status = pir_query_signed_distance(query, &input, NULL, &answer);
        need(status == PIR_OK || status == PIR_ERR_LIMIT, "no answer", number); // the limit of far bodies
        if (status == PIR_OK)
            status = pir_query_certificate(query, &input, &answer, proven, &certificate);
        need(status == PIR_OK || status == PIR_ERR_LIMIT, "no certificate", number);
    }
    if (certificate)
        write_case(&pose, input.translation, is_sum, &answer, certificate);
    pir_query_destroy(query);
    pir_sum_destroy(sum);
    pir_polytope_release(q);
    pir_polytope_release(p);
}

int main(int argc, char **argv) {
    if (argc != 4)
        return 2;
    unsigned long count = strtoul(argv[1], NULL, 10), stride = strtoul(argv[3], NULL, 10);
    for (unsigned long number = strtoul(argv[2], NULL, 10); number < count; number += stride)
        run_case(number);
    return 0;
}
