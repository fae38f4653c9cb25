/* SPDX-License-Identifier: MIT */
/*
 * Any bytes as two small bodies and a motion of both, by small steps and by jumps: answers of a pair that keeps what it
 * has found, of one made for each pose, and of one that has the whole difference, bit for bit; and the state by exact
 * arithmetic where Q stands (place_oracle.h).
 *
 * See fuzz_sum.c for how to run an engine.
 */
#include <math.h>
#include <string.h>

#include <pirouette/pair.h>

#include "fuzz/input.h"
#include "query/place_oracle.h"
#include "support/answers.h"

#define POINTS   8
#define STEPS    12
#define CONTACTS 64

enum way { KEPT = 0, FRESH, WHOLE, WAYS };

struct reply {
    pir_status status, manifold;
    pir_query_result result;
    pir_contact contacts[CONTACTS];
    size_t count;
};

static struct reply ask_pair(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input) {
    struct reply reply;
    memset(&reply, 0, sizeof reply);
    reply.status = pir_pair_signed_distance(pair, workspace, input, &reply.result);
    if (reply.status == PIR_OK)
        reply.manifold =
            pir_pair_manifold(pair, workspace, input, &reply.result, CONTACTS, reply.contacts, &reply.count);
    return reply;
}

static void require_same(const struct reply *a, const struct reply *b, const char *what) {
    fuzz_require(a->status == b->status, "all ways end in one status");
    if (a->status != PIR_OK)
        return;
    fuzz_require(test_same_result(&a->result, &b->result), what);
    fuzz_require(a->manifold == b->manifold && a->count == b->count, "all ways have as many contacts");
    for (size_t i = 0; i < a->count && i < CONTACTS; i++)
        fuzz_require(a->contacts[i].id == b->contacts[i].id &&
                         memcmp(&a->contacts[i].point_p, &b->contacts[i].point_p, sizeof(pir_vec3)) == 0 &&
                         memcmp(&a->contacts[i].point_q, &b->contacts[i].point_q, sizeof(pir_vec3)) == 0 &&
                         memcmp(&a->contacts[i].distance, &b->contacts[i].distance, sizeof(double)) == 0,
                     "all ways have the same contacts");
}

/* Other calls on the pair tell the same state. */
static void check_calls(pir_pair *pair, pir_workspace *workspace, const pir_pair_input *input,
                        const struct reply *right) {
    pir_query_result overlap, apart, depth;
    if (right->status != PIR_OK)
        return;
    fuzz_require(pir_pair_overlap(pair, workspace, input, &overlap) == PIR_OK, "an overlap");
    fuzz_require(pir_pair_distance(pair, workspace, input, &apart) == PIR_OK, "a distance");
    fuzz_require(pir_pair_penetration(pair, workspace, input, &depth) == PIR_OK, "a penetration");
    pir_state state = right->result.state;
    fuzz_require(overlap.state == state && apart.state == state && depth.state == state, "all calls tell one state");
}

/* A place on the boundary of the difference, a small step off the last one, or any vector. */
static pir_vec3 next_place(struct fuzz_input *input, const place_oracle *oracle, pir_vec3 last) {
    uint8_t form = fuzz_byte(input), index = fuzz_byte(input);
    double step = ldexp(1, -(form / 8 % 16) * 4);
    switch (form % 8) {
    case 0:
        return place_oracle_vertex(oracle, index);
    case 1:
        return place_oracle_on_facet(oracle, index);
    case 2:
        return place_oracle_on_edge(oracle, index);
    case 3:
        return (pir_vec3){0, 0, 0};
    case 4: {
        double x = fuzz_double(input), y = fuzz_double(input), z = fuzz_double(input);
        return (pir_vec3){x, y, z};
    }
    default: {
        int x = fuzz_small(input), y = fuzz_small(input), z = fuzz_small(input);
        return (pir_vec3){last.x + step * x / 64, last.y + step * y / 64, last.z + step * z / 64};
    }
    }
}

static void check_state(place_oracle *oracle, const pir_pair_input *input, const struct reply *reply) {
    if (reply->status != PIR_OK)
        return;
    place_answer right = place_oracle_ask(oracle, input->pose_p.translation);
    fuzz_require(reply->result.state == right.state, "the state is the exact one");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    struct fuzz_input bytes = {data, size, 0};
    uint8_t form = fuzz_byte(&bytes);
    pir_polytope *p = fuzz_body(&bytes, POINTS), *q = fuzz_body(&bytes, POINTS);
    pir_pair_options options = pir_pair_options_default(), whole = options;
    whole.least = PIR_LEVEL_WHOLE;
    pir_workspace *workspace = NULL;
    pir_pair *pair[WAYS] = {NULL};
    fuzz_require(pir_workspace_create(NULL, &workspace) == PIR_OK, "a workspace");
    pir_status made = pir_pair_create(p, q, &options, &pair[KEPT]);
    fuzz_require(made == PIR_OK || made == PIR_ERR_LIMIT, "a pair, or bodies too far away");
    fuzz_require(pir_pair_create(p, q, &whole, &pair[WHOLE]) == made, "a pair by the whole difference");
    pir_pair_input input = pir_pair_input_default();
    input.margin = form & 2 ? 0.25 : 0;
    for (int step = 0; step < STEPS && made == PIR_OK && bytes.at < bytes.size; step++) {
        struct reply reply[WAYS];
        input.pose_p.rotation = fuzz_rotation(&bytes, input.pose_p.rotation);
        if (form & 1)
            input.pose_q.rotation = fuzz_rotation(&bytes, input.pose_q.rotation);
        place_oracle *oracle = place_oracle_make(p, q, input.pose_p.rotation);
        input.pose_p.translation = next_place(&bytes, oracle, input.pose_p.translation);
        pir_vec3 t = input.pose_p.translation;
        if (!(isfinite(t.x) && isfinite(t.y) && isfinite(t.z)))
            input.pose_p.translation = (pir_vec3){0, 0, 0};
        fuzz_require(pir_pair_create(p, q, &options, &pair[FRESH]) == PIR_OK, "a pair once more");
        for (int way = 0; way < WAYS; way++)
            reply[way] = ask_pair(pair[way], workspace, &input);
        require_same(&reply[KEPT], &reply[FRESH], "what a pair keeps changes no bit");
        require_same(&reply[KEPT], &reply[WHOLE], "the level changes no bit");
        check_calls(pair[KEPT], workspace, &input, &reply[KEPT]);
        if (!(form & 1))
            check_state(oracle, &input, &reply[KEPT]);
        place_oracle_free(oracle);
        pir_pair_destroy(pair[FRESH]);
    }
    pir_pair_destroy(pair[WHOLE]);
    pir_pair_destroy(pair[KEPT]);
    pir_workspace_destroy(workspace);
    pir_polytope_release(q);
    pir_polytope_release(p);
    return 0;
}
