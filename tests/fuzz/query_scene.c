/* SPDX-License-Identifier: MIT */
/* Bodies and placements for fuzz_query.c: see query_scene.h. */
#include "fuzz/query_scene.h"

/* Numbers are compared where bodies are no farther from their origins, times their size. */
#define FARTHEST 0x1p48

/* --- scenes --- */

/* The greatest coordinate, and the greatest difference of two. */
static void measure(const pir_polytope *p, double *far, double *extent) {
    pir_vec3 low, high;
    pir_polytope_bounds(p, &low, &high);
    *far = fmax(*far, fmax(query_largest(low), query_largest(high)));
    *extent = fmax(*extent, query_largest(query_add(high, low, -1)));
}

/*
 * The limit is 2^400 times the size; 2^397 leaves room for the errors of the measure. Two points count as bodies of
 * size 1, or of their largest coordinate where that is beyond 2^300 or below 2^-300.
 */
int query_may_be_far(const struct query_scene *scene, pir_vec3 t) {
    double far = 0, extent = 0;
    measure(scene->p, &far, &extent);
    measure(scene->q, &far, &extent);
    if (extent == 0)
        extent = far > 0x1p299 || (far > 0 && far < 0x1p-299) ? far : 1;
    return ldexp(fmax(far, query_largest(t)), -397) > extent || !isfinite(extent) || extent < 0x1p-600;
}

struct query_scene query_scene_make(pir_polytope *p, pir_polytope *q, pir_quat rotation) {
    struct query_scene scene = {.p = p, .q = q};
    pir_sum_options options = pir_sum_options_default();
    options.difference = true;
    fuzz_require(pir_sum_create(p, q, rotation, &options, &scene.sum) == PIR_OK, "a sum can be made");
    pir_status status = pir_query_create(scene.sum, &scene.query);
    fuzz_require(status == PIR_OK || (status == PIR_ERR_LIMIT && query_may_be_far(&scene, (pir_vec3){0, 0, 0})),
                 "a query can be made unless a body is far away");
    return scene;
}

void query_scene_free(struct query_scene *scene) {
    pir_query_destroy(scene->query);
    pir_sum_destroy(scene->sum);
    pir_polytope_release(scene->q);
    pir_polytope_release(scene->p);
}

/* --- what is asked --- */

pir_vec3 query_next_vector(struct fuzz_input *input) {
    uint8_t form = fuzz_byte(input);
    int exponent = 4 * fuzz_small(input);
    double c[3];
    for (int k = 0; k < 3; k++)
        c[k] = fuzz_number(input, form % FUZZ_WAYS, exponent);
    return (pir_vec3){c[0], c[1], c[2]};
}

static pir_vec3 next_translation(struct fuzz_input *input, const place_oracle *oracle) {
    uint8_t form = fuzz_byte(input), index = fuzz_byte(input);
    pir_vec3 v = place_oracle_vertex(oracle, index), w = v;
    switch (form % 6) {
    case 0:
        return (pir_vec3){0, 0, 0};
    case 1:
        return query_next_vector(input);
    case 2:
        break;
    case 3:
        v = place_oracle_on_facet(oracle, index);
        break;
    case 4:
        v = place_oracle_on_edge(oracle, index);
        break;
    default:
        // deep inside, most often
        w = place_oracle_vertex(oracle, fuzz_byte(input));
        v = (pir_vec3){v.x / 2 + w.x / 2, v.y / 2 + w.y / 2, v.z / 2 + w.z / 2};
    }
    // as it is, or a small step off
    if (form / 6 % 2) {
        double step = ldexp(place_oracle_size(oracle), -(fuzz_byte(input) % 60));
        pir_vec3 d = {fuzz_small(input) / 128.0, fuzz_small(input) / 128.0, 0};
        d.z = fuzz_small(input) / 128.0;
        v = query_add(v, d, step);
    }
    int finite = isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
    return finite ? v : (pir_vec3){1, 0, 0};
}

struct query_ask query_next_ask(const struct query_scene *scene, struct fuzz_input *input, place_oracle *oracle) {
    struct query_ask ask = {.input = pir_query_input_default(), .oracle = oracle};
    ask.input.translation = next_translation(input, oracle);
    ask.direction = query_next_vector(input);
    ask.right = place_oracle_ask(oracle, ask.input.translation);
    ask.should = ask.right.state == PIR_OUTSIDE  ? ask.right.distance
                 : ask.right.state == PIR_INSIDE ? -ask.right.depth
                                                 : 0;
    double size = place_oracle_size(oracle), reach = size + fabs(ask.should), far = 0, extent = 0;
    measure(scene->p, &far, &extent);
    measure(scene->q, &far, &extent);
    int compared = reach > QUERY_LEAST && reach < QUERY_MOST && query_largest(ask.input.translation) < QUERY_MOST &&
                   far <= FARTHEST * (extent > 0 ? extent : 1);
    ask.far = fmax(far, query_largest(ask.input.translation));
    // points have no size: then coordinates in double-double are what is left
    ask.bound = compared ? QUERY_BOUND * reach + (extent == 0 ? 0x1p-100 * ask.far : 0) : HUGE_VAL;
    return ask;
}
