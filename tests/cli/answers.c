/* SPDX-License-Identifier: MIT */
/*
 * The library's own answers, for tests of the command to hold its JSON against: the same questions asked through the
 * public headers. Prints lines of a key and its values; numbers are hexadecimal, which hold a double exactly.
 *
 *     answers info|mesh|cgm|sum|query|track P [Q] [key=value...]
 *
 * Keys: quat, translate, direction, cast, region (numbers between commas); radius_p, radius_q, tolerance; method, an
 * index into pir_method; difference and exact, 0 or 1; o, a file for the mesh; list, a file of quaternions for track,
 * the first being where the sum is made, or of translations for query.
 */
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

/* The numbers of one key. */
struct numbers {
    bool given;
    double at[4];
};

struct question {
    struct numbers quat, translate, direction, cast, region, radius_p, radius_q, tolerance, method, difference, exact;
    const char *o, *list;
    pir_polytope *p, *q;
};

static void must(pir_status status, const char *what) {
    if (status == PIR_OK)
        return;
    fprintf(stderr, "answers: %s: %s\n", what, pir_status_text(status));
    exit(2);
}

static pir_polytope *load(const char *model) {
    pir_polytope *polytope = NULL;
    if (strncmp(model, "shape:", 6) == 0)
        must(pir_shape_create(model + 6, NULL, NULL, &polytope), model);
    else
        must(pir_polytope_read(model, NULL, NULL, NULL, &polytope), model);
    return polytope;
}

static struct numbers read_numbers(const char *text) {
    struct numbers numbers = {.given = true};
    for (size_t i = 0; i < 4 && *text; i++) {
        char *end;
        numbers.at[i] = strtod(text, &end);
        text = end + (*end == ',');
    }
    return numbers;
}

static void read_key(struct question *question, const char *text) {
    const struct {
        const char *name;
        struct numbers *to;
    } keys[] = {{"quat", &question->quat},           {"translate", &question->translate},
                {"direction", &question->direction}, {"cast", &question->cast},
                {"region", &question->region},       {"radius_p", &question->radius_p},
                {"radius_q", &question->radius_q},   {"tolerance", &question->tolerance},
                {"method", &question->method},       {"difference", &question->difference},
                {"exact", &question->exact}};
    size_t length = strcspn(text, "=");
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strlen(keys[i].name) == length && memcmp(keys[i].name, text, length) == 0)
            *keys[i].to = read_numbers(text + length + 1);
    if (strncmp(text, "o=", 2) == 0)
        question->o = text + 2;
    if (strncmp(text, "list=", 5) == 0)
        question->list = text + 5;
}

static pir_vec3 vector_of(const struct numbers *n) {
    return (pir_vec3){n->at[0], n->at[1], n->at[2]};
}

/* The identity where none is given. */
static pir_quat quaternion_of(const struct numbers *n) {
    return (pir_quat){n->at[0], n->at[1], n->at[2], n->given ? n->at[3] : 1};
}

static void print(const char *key, int count, ...) {
    va_list values;
    va_start(values, count);
    printf("%s", key);
    for (int i = 0; i < count; i++)
        printf(" %a", va_arg(values, double));
    printf("\n");
    va_end(values);
}

static void print_vector(const char *key, pir_vec3 v) {
    print(key, 3, v.x, v.y, v.z);
}

static void print_mesh(const struct question *question, const pir_mesh *mesh) {
    print("mesh", 3, (double)pir_mesh_vertex_count(mesh), (double)pir_mesh_edge_count(mesh),
          (double)pir_mesh_facet_count(mesh));
    if (question->o)
        must(pir_mesh_write(mesh, question->o, (int)question->exact.at[0], NULL), question->o);
}

/* --- the questions --- */

static void info(const struct question *question) {
    pir_vec3 low, high;
    pir_polytope_bounds(question->p, &low, &high);
    print("dimension", 1, (double)pir_polytope_dimension(question->p));
    print("vertices", 1, (double)pir_polytope_vertex_count(question->p));
    print("edges", 1, (double)pir_polytope_edge_count(question->p));
    print("facets", 1, (double)pir_polytope_facet_count(question->p));
    print_vector("low", low);
    print_vector("high", high);
    print("volume", 1, pir_polytope_volume(question->p));
}

static void mesh(const struct question *question) {
    pir_mesh *of_p = NULL;
    must(pir_mesh_from_polytope(question->p, &of_p), "mesh");
    print_mesh(question, of_p);
    pir_mesh_destroy(of_p);
}

static void cgm(const struct question *question) {
    pir_quat rotation = quaternion_of(&question->quat);
    pir_polytope *reflected = NULL;
    pir_cgm *of_p = NULL, *of_q = NULL, *of_sum = NULL;
    if (question->difference.at[0] != 0)
        must(pir_polytope_reflect(question->p, &reflected), "reflect");
    must(pir_cgm_create(reflected ? reflected : question->p, &rotation, NULL, &of_p), "cgm");
    if (question->q) {
        must(pir_cgm_create(question->q, NULL, NULL, &of_q), "cgm");
        must(pir_cgm_overlay(of_p, of_q, &of_sum), "overlay");
    }
    const pir_cgm *whole = of_sum ? of_sum : of_p;
    for (uint32_t map = 0; map < 6; map++) {
        pir_cgm_counts counts = pir_cgm_map_counts(whole, map);
        print(pir_cgm_map_name(map), 3, (double)counts.vertices, (double)counts.halfedges, (double)counts.faces);
    }
    pir_mesh *back = NULL;
    must(pir_cgm_mesh(whole, PIR_DOUBLE, &back), "mesh");
    print_mesh(question, back);
    pir_mesh_destroy(back);
    pir_cgm_release(of_sum);
    pir_cgm_release(of_q);
    pir_cgm_release(of_p);
    pir_polytope_release(reflected);
}

static pir_sum *make_sum(const struct question *question, int difference, pir_quat rotation) {
    pir_sum *sum = NULL;
    pir_sum_options options = pir_sum_options_default();
    options.difference = difference;
    must(pir_sum_create(question->p, question->q, rotation, &options, &sum), "sum");
    return sum;
}

static void sum(const struct question *question) {
    pir_sum *of_both = make_sum(question, (int)question->difference.at[0], quaternion_of(&question->quat));
    print("fv", 1, (double)pir_polytope_facet_count(pir_sum_p(of_both)));
    print("vf", 1, (double)pir_polytope_facet_count(pir_sum_q(of_both)));
    print("ee", 1, (double)pir_sum_ee_count(of_both));
    pir_mesh *of_sum = NULL;
    must(pir_sum_mesh(of_both, question->exact.at[0] != 0 ? PIR_EXACT : PIR_DOUBLE, &of_sum), "mesh");
    print_mesh(question, of_sum);
    pir_mesh_destroy(of_sum);
    pir_sum_destroy(of_both);
}

static void print_answer(const pir_query_result *r) {
    print("state", 1, (double)r->state);
    print("distance", 1, r->distance);
    print_vector("normal", r->normal);
    print_vector("p", r->point_p);
    print_vector("q", r->point_q);
    print("witness", 4, (double)r->witness.p.kind, (double)r->witness.p.index, (double)r->witness.q.kind,
          (double)r->witness.q.index);
    print("steps", 1, (double)r->steps);
}

/* Each translation of the list, with one cache from first to last. */
static void print_list(pir_query *query, const char *list, pir_query_input input) {
    FILE *file = fopen(list, "r");
    char line[256];
    pir_query_cache cache = {0};
    while (file && fgets(line, sizeof line, file)) {
        struct numbers t = read_numbers(line);
        pir_query_result result;
        input.translation = vector_of(&t);
        must(pir_query_signed_distance(query, &input, &cache, &result), "query");
        print("row", 8, t.at[0], t.at[1], t.at[2], (double)result.state, result.distance, result.normal.x,
              result.normal.y, result.normal.z);
    }
    if (file)
        fclose(file);
}

static void print_directional(pir_query *query, const pir_query_input *input, pir_vec3 direction, pir_state state) {
    pir_query_result along;
    if (state == PIR_INSIDE)
        must(pir_query_directional_depth(query, input, direction, &along), "direction");
    else
        must(pir_query_directional_distance(query, input, direction, &along), "direction");
    print("directional", 2, along.distance, (double)(along.outcome == PIR_NO_HIT));
}

static void query(const struct question *question) {
    pir_query *query = NULL;
    pir_sum *difference = make_sum(question, 1, quaternion_of(&question->quat));
    must(pir_query_create(difference, &query), "query");
    pir_query_input input = pir_query_input_default();
    input.translation = vector_of(&question->translate);
    input.radius_p = question->radius_p.at[0];
    input.radius_q = question->radius_q.at[0];
    if (question->list) {
        print_list(query, question->list, input);
    } else {
        pir_query_result result;
        must(pir_query_signed_distance(query, &input, NULL, &result), "query");
        print_answer(&result);
        if (question->direction.given)
            print_directional(query, &input, vector_of(&question->direction), result.state);
        if (question->cast.given) {
            pir_impact cast;
            must(pir_query_cast(query, &input, vector_of(&question->cast), &cast), "cast");
            print("cast", 5, (double)cast.outcome, cast.time, cast.normal.x, cast.normal.y, cast.normal.z);
        }
    }
    pir_query_destroy(query);
    pir_sum_destroy(difference);
}

static void track(const struct question *question) {
    FILE *file = fopen(question->list, "r");
    char line[256];
    pir_sum *tracked = NULL;
    double shortfall = 0;
    while (file && fgets(line, sizeof line, file)) {
        struct numbers n = read_numbers(line);
        if (tracked) {
            must(pir_sum_rotate(tracked, quaternion_of(&n), (pir_method)question->method.at[0]), "rotate");
            double bound = pir_sum_shortfall_bound(tracked);
            shortfall = bound > shortfall ? bound : shortfall;
            continue;
        }
        tracked = make_sum(question, (int)question->difference.at[0], quaternion_of(&n));
        must(pir_sum_set_tolerance(tracked, question->tolerance.at[0]), "tolerance");
        if (question->region.given)
            must(pir_sum_set_region(tracked, vector_of(&question->region),
                                    question->region.at[3] * (3.14159265358979323846 / 180)),
                 "region");
        pir_sum_reset_statistics(tracked);
    }
    pir_sum_statistics did = pir_sum_get_statistics(tracked);
    print("updates", 1, (double)did.updates);
    print("rebuilds", 1, (double)did.rebuilds);
    print("kept", 1, (double)did.kept);
    print("checked", 1, (double)did.checked);
    print("repaired", 1, (double)did.repaired);
    print("signs", 3, (double)did.by_filter, (double)did.by_exact, (double)did.by_perturbation);
    print("shortfall", 1, shortfall);
    pir_sum_destroy(tracked);
    if (file)
        fclose(file);
}

int main(int argc, char **argv) {
    static const struct {
        const char *name;
        void (*answer)(const struct question *);
    } kinds[] = {{"info", info}, {"mesh", mesh}, {"cgm", cgm}, {"sum", sum}, {"query", query}, {"track", track}};
    struct question question = {0};
    if (argc < 3)
        return 2;
    question.p = load(argv[2]);
    for (int i = 3; i < argc; i++)
        if (strchr(argv[i], '='))
            read_key(&question, argv[i]);
        else
            question.q = load(argv[i]);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (strcmp(kinds[i].name, argv[1]) == 0)
            kinds[i].answer(&question);
    pir_polytope_release(question.q);
    pir_polytope_release(question.p);
    return 0;
}
