/* SPDX-License-Identifier: MIT */
/*
 * Reads any bytes as two small bodies and three rotations, with a few translations at each: zero, on vertices, edges
 * and facets of the difference, a small step off them, tiny, huge, any double. Every query is asked. States are
 * compared with exact arithmetic (place_oracle.h), and numbers where doubles can hold them. Each answer's own
 * invariants are checked, and the answers of different calls, of the reflected pose and of the swapped pose are
 * compared.
 *
 * See fuzz_sum.c for how to run an engine.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/ccd.h>
#include <pirouette/pirouette.h>

#include "fuzz/query_scene.h"
#include "support/bodies.h"
#include "support/turning.h"

#define POINTS    8
#define ROTATIONS 3
#define ASKS      3

/*
 * The error along a direction. A contact may graze, and a flat difference may be missed by little: then digits are
 * lost.
 */
#define GRAZING 1e-9

static void require_near(double a, double b, double bound, const char *what) {
    // where both overflow they are equal
    if (!(fabs(a - b) <= bound) && a != b && bound < HUGE_VAL) {
        fprintf(stderr, "%.17g is not %.17g within %.3g: ", a, b, bound);
        fuzz_require(0, what);
    }
}

/* --- checks of one placement --- */

static void check_answer(const struct query_ask *ask, const pir_query_result *r) {
    static const pir_outcome outcomes[] = {
        [PIR_OUTSIDE] = PIR_SEPARATED, [PIR_BOUNDARY] = PIR_TOUCHING, [PIR_INSIDE] = PIR_OVERLAPPING};
    fuzz_require(r->state == ask->right.state, "the state is the exact one");
    fuzz_require(r->outcome == outcomes[r->state] || (r->outcome == PIR_STEP_LIMIT && ask->bound == HUGE_VAL),
                 "the outcome is that of the state");
    fuzz_require(r->state == PIR_OUTSIDE  ? r->distance >= 0
                 : r->state == PIR_INSIDE ? r->distance <= 0
                                          : r->distance == 0,
                 "the sign of the distance is that of the state");
    require_near(r->distance, ask->should, ask->bound, "the signed distance");
    fuzz_require(r->witness.p.kind != PIR_FEATURE_NONE && r->witness.q.kind != PIR_FEATURE_NONE, "there is a witness");
    if (ask->bound == HUGE_VAL)
        return;
    require_near(query_length(r->normal), 1, 1e-14, "the normal is a unit vector");
    double far = query_largest(r->point_p) + query_largest(r->point_q);
    require_near(query_length(query_add(r->point_p, query_add(r->point_q, r->normal, r->distance), -1)), 0,
                 ask->bound + 0x1p-50 * far, "P's point is Q's plus the distance along the normal");
    require_near(place_oracle_slack(ask->oracle, ask->input.translation, r->normal), -ask->should, 2 * ask->bound,
                 "the normal proves the distance");
}

static pir_query_result check_distances(struct query_scene *scene, const struct query_ask *ask) {
    pir_query *query = scene->query;
    const pir_query_input *input = &ask->input;
    pir_query_cache none = {0};
    pir_query_result warm, cold, overlap, depth, apart;
    fuzz_require(pir_query_signed_distance(query, input, &scene->cache, &warm) == PIR_OK, "a distance, warm");
    fuzz_require(pir_query_signed_distance(query, input, &none, &cold) == PIR_OK, "a distance, cold");
    fuzz_require(pir_query_overlap(query, input, &scene->cache, &overlap) == PIR_OK, "an overlap");
    fuzz_require(pir_query_penetration(query, input, &scene->cache, &depth) == PIR_OK, "a penetration");
    fuzz_require(pir_query_distance(query, input, NULL, &apart) == PIR_OK, "a separation");
    check_answer(ask, &warm);
    check_answer(ask, &cold);
    pir_state state = ask->right.state;
    fuzz_require(overlap.state == state && depth.state == state && apart.state == state, "all calls tell one state");
    if (state == PIR_INSIDE) {
        check_answer(ask, &depth);
        fuzz_require(memcmp(&warm.normal, &cold.normal, sizeof warm.normal) == 0 && warm.distance == cold.distance,
                     "a depth is the same warm and cold");
    } else {
        check_answer(ask, &apart);
    }
    fuzz_require(state == PIR_INSIDE ? apart.distance == 0 : depth.distance == 0,
                 "a call tells nothing of the other side");
    return cold;
}

/* Rounding radii shift the distance, and a cutoff is a bound that holds. */
static void check_radii_and_cutoff(struct query_scene *scene, const struct query_ask *ask) {
    pir_query_input input = ask->input;
    pir_query_result r;
    double size = place_oracle_size(ask->oracle);
    input.radius_p = size / 4;
    input.radius_q = size / 16;
    if (ask->bound == HUGE_VAL)
        return;
    fuzz_require(pir_query_signed_distance(scene->query, &input, NULL, &r) == PIR_OK, "a distance with radii");
    require_near(r.distance, ask->should - size / 4 - size / 16, 2 * ask->bound, "the distance of rounded bodies");
    fuzz_require(r.state == (r.distance > 0   ? PIR_OUTSIDE
                             : r.distance < 0 ? PIR_INSIDE
                                              : PIR_BOUNDARY),
                 "with radii the distance tells the state");
    input = ask->input;
    input.cutoff = fabs(ask->should) / 2;
    fuzz_require(pir_query_distance(scene->query, &input, NULL, &r) == PIR_OK, "a distance with a cutoff");
    fuzz_require(r.state == ask->right.state, "a cutoff changes no state");
    if (r.outcome == PIR_BEYOND_CUTOFF)
        fuzz_require(ask->right.state == PIR_OUTSIDE && r.distance >= input.cutoff &&
                         r.distance <= ask->should + ask->bound,
                     "beyond the cutoff there is a bound that holds");
}

static void check_batches(struct query_scene *scene, const struct query_ask *ask, const pir_query_result *single) {
    pir_vec3 t[3] = {ask->input.translation, ask->input.translation, {0, 0, 0}};
    pir_state states[3];
    double depths[3], distances[3];
    fuzz_require(pir_query_batch_states(scene->query, t, 3, states) == PIR_OK, "a batch of states");
    fuzz_require(states[0] == single->state && states[1] == single->state, "a batch tells the same state");
    fuzz_require(pir_query_batch_depths(scene->query, t, 3, depths, states) == PIR_OK, "a batch of depths");
    fuzz_require(states[0] == single->state && depths[0] == depths[1], "a batch tells the same twice");
    require_near(depths[0], single->state == PIR_INSIDE ? -single->distance : 0, 2 * ask->bound, "a depth of a batch");
    fuzz_require(pir_query_batch_distances(scene->query, t, 3, distances, states) == PIR_OK, "a batch of distances");
    fuzz_require(states[1] == single->state, "a batch tells the same state");
    require_near(distances[0], single->distance, 2 * ask->bound, "a distance of a batch");
}

static void check_escapes(struct query_scene *scene, const struct query_ask *ask, const pir_query_result *single) {
    pir_escape escapes[64];
    size_t count = 64;
    double slack = ask->right.state == PIR_INSIDE ? ask->right.depth / 2 : 0, least = HUGE_VAL;
    fuzz_require(pir_query_escapes(scene->query, &ask->input, slack, 64, escapes, &count) == PIR_OK, "escapes");
    fuzz_require((count > 0) == (ask->right.state == PIR_INSIDE), "there are escapes where there is an overlap");
    if (ask->bound == HUGE_VAL || count > 64)
        return;
    for (size_t i = 0; i < count; i++) {
        const pir_escape *e = &escapes[i];
        least = fmin(least, e->depth);
        fuzz_require(e->depth <= ask->right.depth + slack + 2 * ask->bound, "an escape is within the slack");
        require_near(place_oracle_slack(ask->oracle, ask->input.translation, e->normal), e->depth, 2 * ask->bound,
                     "the normal proves the escape");
    }
    if (count > 0)
        require_near(least, -single->distance, 2 * ask->bound, "the least escape is the depth");
}

/* Checks that P, moved by the answer's distance, touches: neither deep nor apart. */
static void check_contact(const struct query_ask *ask, double distance, const char *what) {
    double size = query_largest(ask->direction);
    pir_vec3 u = {ask->direction.x / size, ask->direction.y / size, ask->direction.z / size};
    double reach = place_oracle_size(ask->oracle) + fabs(ask->should) + distance;
    if (ask->bound == HUGE_VAL || !(reach < QUERY_MOST))
        return;
    pir_vec3 there = query_add(ask->input.translation, u, distance / query_length(u));
    place_answer at = place_oracle_ask(ask->oracle, there);
    double off = at.state == PIR_OUTSIDE ? at.distance : at.state == PIR_INSIDE ? at.depth : 0;
    require_near(off, 0, GRAZING * reach + 64 * QUERY_BOUND * ask->far, what);
}

static void check_directions(struct query_scene *scene, const struct query_ask *ask, const pir_query_result *single) {
    pir_query_result depth, apart;
    pir_impact cast;
    pir_state state = ask->right.state;
    int still = query_largest(ask->direction) == 0;
    pir_status status = still ? PIR_ERR_ARGUMENT : PIR_OK;
    fuzz_require(pir_query_directional_depth(scene->query, &ask->input, ask->direction, &depth) == status &&
                     pir_query_directional_distance(scene->query, &ask->input, ask->direction, &apart) == status,
                 "directions but zero are taken");
    fuzz_require(pir_query_cast(scene->query, &ask->input, ask->direction, &cast) == PIR_OK, "a cast");
    fuzz_require(cast.time >= 0 && cast.time <= 1, "a cast ends within its motion");
    fuzz_require((cast.outcome == PIR_CAST_START_INSIDE) == (state == PIR_INSIDE), "a cast knows where it starts");
    if (still)
        return;
    fuzz_require(depth.state == state && apart.state == state, "directions change no state");
    fuzz_require((depth.outcome == PIR_NO_HIT) == (state != PIR_INSIDE), "a directional depth is that of an overlap");
    if (state == PIR_INSIDE) {
        require_near(fmin(-depth.distance + single->distance, 0), 0, ask->bound / QUERY_BOUND * GRAZING,
                     "no way out is shorter than the depth");
        check_contact(ask, -depth.distance, "moved by the directional depth P touches");
    }
    if (state == PIR_OUTSIDE && apart.outcome == PIR_SEPARATED) {
        require_near(fmin(apart.distance - single->distance, 0), 0, ask->bound / QUERY_BOUND * GRAZING,
                     "no way is shorter than the distance");
        check_contact(ask, apart.distance, "moved by the directional distance P touches");
    }
    if (cast.outcome == PIR_CAST_HIT && state == PIR_OUTSIDE)
        check_contact(ask, cast.time * query_length(ask->direction), "at the time of impact P touches");
}

static void check_rest(struct query_scene *scene, const struct query_ask *ask, const pir_query_result *single) {
    pir_query_result most;
    fuzz_require(pir_query_largest_distance(scene->query, &ask->input, &most) == PIR_OK, "a largest distance");
    fuzz_require(most.state == ask->right.state, "the largest distance changes no state");
    double farthest = 0;
    // vertices of the difference come round again after as many as it has
    for (uint32_t i = 0; i < POINTS * POINTS; i++)
        farthest =
            fmax(farthest, query_length(query_add(place_oracle_vertex(ask->oracle, i), ask->input.translation, -1)));
    require_near(most.distance, farthest, ask->bound + 0x1p-48 * ask->far, "the largest distance");
    pir_contact contacts[64];
    size_t count = 0;
    fuzz_require(pir_query_manifold(scene->query, &ask->input, single, 64, contacts, &count) == PIR_OK, "a manifold");
    fuzz_require(count > 0 && count <= 64, "a manifold has a contact");
    fuzz_require(contacts[0].distance == single->distance && contacts[0].point_q.x == single->point_q.x,
                 "a manifold holds its answer");
    for (size_t i = 0; i < count; i++)
        fuzz_require(isfinite(contacts[i].distance), "a contact has a distance");
}

/* Checks support functions alone. They are not exact, but what they say is true. */
static void check_pair(const struct query_scene *scene, const struct query_ask *ask) {
    pir_ccd_pair pair = {scene->p, scene->q, pir_sum_rotation(scene->sum), ask->input.translation};
    pir_ccd_outcome outcome, overlap;
    double distance = 0;
    pir_status status = pir_ccd_distance(&pair, &outcome, &distance);
    fuzz_require(status == pir_ccd_overlap(&pair, &overlap), "supports alone");
    if (status == PIR_ERR_NOT_BUILT)
        return;
    fuzz_require(status == PIR_OK || (status == PIR_ERR_LIMIT && query_may_be_far(scene, pair.translation)),
                 "pairs are taken unless they are far away");
    // two points have no size to be compared with
    if (status != PIR_OK || ask->bound == HUGE_VAL || place_oracle_size(ask->oracle) == 0)
        return;
    double bound = ask->bound / QUERY_BOUND * 1e-8 + 0x1p-48 * ask->far;
    if (outcome == PIR_CCD_SEPARATED)
        require_near(distance, fmax(ask->should, 0), bound, "the distance by supports");
    if (outcome == PIR_CCD_OVERLAPPING)
        require_near(fmax(ask->should, 0), 0, bound, "an overlap by supports");
}

/* Checks the farthest vertex of P along the direction against the exact hull of P alone, rotated. */
static void check_support(const struct query_scene *scene, const struct query_ask *ask) {
    static const pir_vec3 origin = {0, 0, 0};
    pir_support_body body = {scene->p, pir_sum_rotation(scene->sum), origin, 0};
    double size = query_largest(ask->direction), point[3];
    if (ask->bound == HUGE_VAL || size == 0)
        return;
    pir_vec3 d = {ask->direction.x / size, ask->direction.y / size, ask->direction.z / size};
    pir_support_body_ccd(&body, &ask->direction.x, point);
    pir_polytope *zero = NULL;
    fuzz_require(pir_polytope_create(&origin, 1, NULL, &zero) == PIR_OK, "the origin is a polytope");
    // the difference of the two is P turned and reflected
    place_oracle *alone = place_oracle_make(scene->p, zero, body.rotation);
    double far = 0, most = place_oracle_slack(alone, origin, (pir_vec3){-d.x, -d.y, -d.z});
    for (uint32_t i = 0; i < POINTS; i++)
        far = fmax(far, query_largest(place_oracle_vertex(alone, i)));
    require_near((d.x * point[0] + d.y * point[1] + d.z * point[2]) / query_length(d), most, 0x1p-40 * far,
                 "the support along a direction");
    place_oracle_free(alone);
    pir_polytope_release(zero);
}

/* Checks that the bodies and the pose reflected through the origin have the reflected answer. */
static void check_reflected(const struct query_scene *scene, const struct query_ask *ask,
                            const pir_query_result *single) {
    pir_polytope *p = NULL, *q = NULL;
    fuzz_require(pir_polytope_reflect(scene->p, &p) == PIR_OK, "P is reflected");
    fuzz_require(pir_polytope_reflect(scene->q, &q) == PIR_OK, "Q is reflected");
    struct query_scene mirror = query_scene_make(p, q, pir_sum_rotation(scene->sum));
    pir_query_input input = ask->input;
    input.translation = (pir_vec3){-input.translation.x, -input.translation.y, -input.translation.z};
    pir_query_result r;
    fuzz_require(pir_query_signed_distance(mirror.query, &input, NULL, &r) == PIR_OK, "a distance, reflected");
    fuzz_require(r.state == single->state, "a reflection changes no state");
    require_near(r.distance, single->distance, 2 * ask->bound, "a reflection changes no distance");
    query_scene_free(&mirror);
}

/*
 * Checks that Q against P has the mirrored answer: the inverse rotation, and the translation rotated back, which is
 * exact where R is a signed permutation.
 */
static void check_swapped(const struct query_scene *scene, const struct query_ask *ask,
                          const pir_query_result *single) {
    pir_quat r = pir_sum_rotation(scene->sum);
    pir_vec3 t = ask->input.translation;
    double square = r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w, most = fmax(1, query_largest(t));
    // beyond these sizes the products below overflow or underflow
    if (!(square > QUERY_LEAST && square < QUERY_MOST && most < QUERY_MOST))
        return;
    double x = r.x, y = r.y, z = r.z, w = r.w;
    pir_quat back = {-x, -y, -z, w};
    pir_vec3 turned = {
        -((x * x - y * y - z * z + w * w) * t.x + 2 * (x * y + z * w) * t.y + 2 * (x * z - y * w) * t.z) / square,
        -(2 * (x * y - z * w) * t.x + (y * y - x * x - z * z + w * w) * t.y + 2 * (y * z + x * w) * t.z) / square,
        -(2 * (x * z + y * w) * t.x + 2 * (y * z - x * w) * t.y + (z * z - x * x - y * y + w * w) * t.z) / square};
    struct query_scene swapped = query_scene_make(pir_polytope_retain(scene->q), pir_polytope_retain(scene->p), back);
    pir_query_input input = pir_query_input_default();
    input.translation = turned;
    pir_query_result s;
    pir_status status = swapped.query ? pir_query_signed_distance(swapped.query, &input, NULL, &s) : PIR_ERR_LIMIT;
    fuzz_require(status == PIR_OK || query_may_be_far(&swapped, turned), "a distance, swapped");
    double bound = 2 * ask->bound + 0x1p-48 * ask->far;
    if (status == PIR_OK)
        require_near(s.distance, single->distance, bound, "swapping the bodies changes no distance");
    if (status == PIR_OK && fabs(ask->should) > bound)
        fuzz_require(s.state == single->state, "swapping the bodies changes no state");
    query_scene_free(&swapped);
}

/* Checks that P moves and turns until it touches, safely. The sum is left at the last rotation. */
static void check_advance(struct query_scene *scene, const struct query_ask *ask, struct fuzz_input *input) {
    test_turning motion = {.rotation = pir_sum_rotation(scene->sum), .start = ask->input.translation};
    motion.motion = ask->direction;
    motion.axis = query_next_vector(input);
    motion.angle = fuzz_small(input) / 16.0;
    double tolerance = 1e-6 * place_oracle_size(ask->oracle);
    if (!(tolerance > QUERY_LEAST && tolerance < QUERY_MOST))
        return;
    pir_impact cast;
    pir_status status = test_impact(scene->query, scene->sum, &motion, tolerance, &cast);
    if (status != PIR_OK) {
        pir_vec3 end = query_add(motion.start, motion.motion, 1);
        fuzz_require((status == PIR_ERR_LIMIT && query_may_be_far(scene, end)) ||
                         (status == PIR_ERR_NOT_FINITE && !isfinite(query_largest(end))),
                     "a motion is followed");
        return;
    }
    fuzz_require(cast.time >= 0 && cast.time <= 1, "an advance ends within its motion");
    fuzz_require((cast.outcome == PIR_CAST_START_INSIDE) == (ask->right.state == PIR_INSIDE),
                 "an advance knows where it starts");
    if (cast.outcome != PIR_CAST_HIT)
        return;
    pir_query_input at = pir_query_input_default();
    pir_query_result there;
    at.translation = query_add(motion.start, motion.motion, cast.time);
    fuzz_require(pir_query_signed_distance(scene->query, &at, NULL, &there) == PIR_OK, "a distance where it ends");
    fuzz_require(there.distance <= tolerance && there.state != PIR_INSIDE, "at the end P is next to Q, and not in it");
}

static void check_placement(struct query_scene *scene, const struct query_ask *ask) {
    pir_state state;
    pir_status status = pir_query_batch_states(scene->query, &ask->input.translation, 1, &state);
    fuzz_require(status == PIR_OK || (status == PIR_ERR_LIMIT && query_may_be_far(scene, ask->input.translation)),
                 "translations are taken unless they are far away");
    if (status != PIR_OK)
        return;
    pir_query_result single = check_distances(scene, ask);
    check_radii_and_cutoff(scene, ask);
    check_batches(scene, ask, &single);
    check_escapes(scene, ask, &single);
    check_directions(scene, ask, &single);
    check_rest(scene, ask, &single);
    check_pair(scene, ask);
    check_support(scene, ask);
    check_reflected(scene, ask, &single);
    check_swapped(scene, ask, &single);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input input = {data, size, 0};
    uint8_t form = fuzz_byte(&input);
    pir_polytope *p = fuzz_body(&input, POINTS);
    pir_polytope *q = form & 1 ? pir_polytope_retain(p) : fuzz_body(&input, POINTS);
    pir_quat rotation = fuzz_rotation(&input, (pir_quat){0, 0, 0, 1});
    struct query_scene scene = query_scene_make(p, q, rotation);
    for (int turn = 0; turn < ROTATIONS && scene.query && (turn == 0 || input.at < size); turn++) {
        fuzz_require(pir_sum_rotate(scene.sum, rotation, PIR_METHOD_AUTO) == PIR_OK, "a sum can be turned");
        place_oracle *oracle = place_oracle_make(p, q, rotation);
        struct query_ask ask = {0};
        for (int i = 0; i < ASKS && (i == 0 || input.at < size); i++) {
            ask = query_next_ask(&scene, &input, oracle);
            check_placement(&scene, &ask);
        }
        pir_state state;
        if (pir_query_batch_states(scene.query, &ask.input.translation, 1, &state) == PIR_OK)
            check_advance(&scene, &ask, &input);
        place_oracle_free(oracle);
        rotation = fuzz_rotation(&input, rotation);
    }
    query_scene_free(&scene);
    return 0;
}
