/* SPDX-License-Identifier: MIT */
/*
 * A direction n proves that two bodies overlap by no more than they do along n, |n| apart. A pair made for the question
 * says which direction to look at; how far the bodies reach along it is computed here with rationals, from their exact
 * vertices and the exact rotations that their quaternions stand for. So a wrong direction cannot make a depth less.
 */
#include "depths.h"

#include <math.h>

#include <gmp.h>

#include <pirouette/exact.h>

#include "support/test.h"
#include "support/vectors.h"

/* R as |q|² R, and |q|². */
struct turn {
    mpq_t row[3][3], length;
};

static void turn_init(struct turn *turn, pir_quat q) {
    const double of[4] = {q.x, q.y, q.z, q.w};
    mpq_t c[4], square[4][4], sum;
    mpq_init(sum);
    for (int i = 0; i < 4; i++) {
        mpq_init(c[i]);
        mpq_set_d(c[i], of[i]);
    }
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++) {
            mpq_init(square[i][k]);
            mpq_mul(square[i][k], c[i], c[k]);
        }
    mpq_init(turn->length);
    for (int i = 0; i < 4; i++)
        mpq_add(turn->length, turn->length, square[i][i]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            mpq_init(turn->row[i][k]);
            mpq_add(sum, square[i][k], square[i][k]);
            if (i == k) // w² + x² − y² − z² = 2 (w² + x²) − |q|²
                mpq_add(sum, sum, square[3][3]), mpq_add(sum, sum, square[3][3]), mpq_sub(sum, sum, turn->length);
            else { // ± 2 w times the third component
                mpq_t *other = &square[3][3 - i - k];
                for (int twice = 0; twice < 2; twice++)
                    ((k + 3 - i) % 3 == 1 ? mpq_sub : mpq_add)(sum, sum, *other);
            }
            mpq_set(turn->row[i][k], sum);
        }
    for (int i = 0; i < 4; i++) {
        for (int k = 0; k < 4; k++)
            mpq_clear(square[i][k]);
        mpq_clear(c[i]);
    }
    mpq_clear(sum);
}

static void turn_clear(struct turn *turn) {
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            mpq_clear(turn->row[i][k]);
    mpq_clear(turn->length);
}

/* How far a body reaches along `sign` n, exactly. */
static void reach(mpq_t ret, const pir_polytope *body, pir_pose pose, pir_vec3 n, int sign) {
    struct turn turn;
    mpq_t along[3], in_body[3], coordinate[3], term, sum;
    const double of_n[3] = {sign * n.x, sign * n.y, sign * n.z};
    const double place[3] = {pose.translation.x, pose.translation.y, pose.translation.z};
    turn_init(&turn, pose.rotation);
    mpq_inits(term, sum, NULL);
    mpq_set_ui(ret, 0, 1);
    for (int i = 0; i < 3; i++) {
        mpq_inits(along[i], in_body[i], coordinate[i], NULL);
        mpq_set_d(along[i], of_n[i]);
        mpq_set_d(term, place[i]);
        mpq_mul(term, term, along[i]);
        mpq_add(ret, ret, term);
    }
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            mpq_mul(term, turn.row[i][k], along[i]);
            mpq_add(in_body[k], in_body[k], term);
        }
        mpq_div(in_body[k], in_body[k], turn.length);
    }
    mpq_t best;
    mpq_init(best);
    for (uint32_t v = 0; v < pir_polytope_vertex_count(body); v++) {
        pir_polytope_vertex_exact(body, v, coordinate);
        mpq_set_ui(sum, 0, 1);
        for (int k = 0; k < 3; k++) {
            mpq_mul(term, coordinate[k], in_body[k]);
            mpq_add(sum, sum, term);
        }
        if (v == 0 || mpq_cmp(sum, best) > 0)
            mpq_set(best, sum);
    }
    mpq_add(ret, ret, best);
    for (int i = 0; i < 3; i++)
        mpq_clears(along[i], in_body[i], coordinate[i], NULL);
    mpq_clears(term, sum, best, NULL);
    turn_clear(&turn);
}

/* How far both overlap along n, in lengths: below 0 where n separates them. */
static double overlap(const pir_polytope *p, pir_pose at_p, const pir_polytope *q, pir_pose at_q, pir_vec3 n) {
    mpq_t of_p, of_q;
    mpq_inits(of_p, of_q, NULL);
    reach(of_p, p, at_p, n, -1);
    reach(of_q, q, at_q, n, 1);
    mpq_add(of_p, of_p, of_q);
    double both = mpq_get_d(of_p);
    mpq_clears(of_p, of_q, NULL);
    return both / test_length(n);
}

/* The radius of a ball about the origin that holds a piece. */
static double ball(const pir_polytope *piece) {
    double radius = 0;
    for (uint32_t v = 0; v < pir_polytope_vertex_count(piece); v++)
        radius = fmax(radius, test_length(pir_polytope_vertex(piece, v)));
    return radius;
}

/* Twice the greatest distance of a vertex from the middle of all: about the longest way through a piece. */
static double size_of(const pir_polytope *piece) {
    uint32_t count = pir_polytope_vertex_count(piece);
    pir_vec3 middle = test_zero;
    double most = 0;
    for (uint32_t v = 0; v < count; v++)
        middle = test_add(middle, pir_polytope_vertex(piece, v), 1. / count);
    for (uint32_t v = 0; v < count; v++)
        most = fmax(most, test_length(test_add(pir_polytope_vertex(piece, v), middle, -1)));
    return 2 * most;
}

static void look_at(struct depths *worst, pir_workspace *workspace, pir_polytope *p, pir_polytope *q,
                    const pir_pair_input *input) {
    pir_pair *pair = NULL;
    pir_query_result answer;
    assert_int_equal(pir_pair_create(p, q, NULL, &pair), PIR_OK);
    assert_int_equal(pir_pair_signed_distance(pair, workspace, input, &answer), PIR_OK);
    pir_pair_destroy(pair);
    double depth = overlap(p, input->pose_p, q, input->pose_q, answer.normal);
    worst->pairs++;
    worst->depth = fmax(worst->depth, depth);
    worst->relative = fmax(worst->relative, depth / fmin(size_of(p), size_of(q)));
}

struct depths depths_of(const struct stage *stage, const struct world *world) {
    struct depths worst = {0};
    pir_workspace *workspace = NULL;
    assert_int_equal(pir_workspace_create(NULL, &workspace), PIR_OK);
    for (uint32_t i = 0; i < stage->body_count; i++)
        for (uint32_t k = i + 1; k < stage->body_count; k++) {
            const struct world_body *a = &stage->body[i].body, *b = &stage->body[k].body;
            pir_pair_input input = pir_pair_input_default();
            input.pose_p = world_motion(world, i).pose;
            input.pose_q = world_motion(world, k).pose;
            double apart = test_length(test_add(input.pose_p.translation, input.pose_q.translation, -1));
            if ((a->kind != PIR_BODY_MOVING && b->kind != PIR_BODY_MOVING) ||
                apart > a->shape->radius + b->shape->radius)
                continue;
            double before = worst.relative;
            for (uint32_t s = 0; s < a->shape->count; s++)
                for (uint32_t t = 0; t < b->shape->count; t++)
                    if (apart <= ball(a->shape->piece[s]) + ball(b->shape->piece[t]))
                        look_at(&worst, workspace, a->shape->piece[s], b->shape->piece[t], &input);
            if (worst.relative > before) {
                worst.p = i;
                worst.q = k;
            }
        }
    pir_workspace_destroy(workspace);
    return worst;
}
