/* SPDX-License-Identifier: MIT */
/*
 * See piece_frame.h. Exact coordinates are V·num/den of a polytope's integers V, of A' −M·V·num/(den·|q|²). A
 * unit normal of a polytope is within 2^-49 of the true one and R within 37·2^-53: with rounding less than 2^-47.
 */
#include "solid/depth/piece_frame.h"

#include "polytope/polytope.h"

static bool reserve(pir_framed_body *body, const pir_compound *c, const pir_allocator *a) {
    *body = (pir_framed_body){.of = c, .edge_start = PIR_ZEROED(a, uint32_t, (size_t)c->count + 1)};
    if (!body->edge_start)
        return false;
    for (uint32_t i = 0; i < c->count; i++)
        body->edge_start[i + 1] = body->edge_start[i] + c->piece[i]->edge_count;
    const size_t edges = body->edge_start[c->count];
    body->edge = PIR_NEW(a, pir_framed_edge, edges);
    body->vertex = (double(*)[3])PIR_NEW(a, double, 3 * (size_t)c->vertex_start[c->count]);
    body->normal = (double(*)[3])PIR_NEW(a, double, 3 * (size_t)c->face_start[c->count]);
    body->height = PIR_NEW(a, double, c->face_start[c->count]);
    body->along = (double(*)[3])PIR_NEW(a, double, 3 * edges);
    body->own_along = (double(*)[3])PIR_NEW(a, double, 3 * edges);
    body->box = PIR_NEW(a, pir_space_box, c->count);
    body->line = (uint32_t(*)[2])PIR_NEW(a, uint32_t, 2 * edges);
    return body->line && body->edge && body->vertex && body->normal && body->height && body->along && body->own_along &&
           body->box;
}

/* The line of an edge: one that both of its ends are on, or a new one. */
static uint32_t line_of(pir_framed_body *body, const pir_framed_edge *edge) {
    const pir_shared_features *shared = &body->shared;
    const uint32_t a = shared->vertex[edge->origin], b = shared->vertex[edge->target];
    for (uint32_t line = 0; line < body->lines; line++)
        if (pir_framed_on_line(body, line, a) && pir_framed_on_line(body, line, b))
            return line;
    body->line[body->lines][0] = shared->plane[edge->left];
    body->line[body->lines][1] = shared->plane[edge->right];
    return body->lines++;
}

static void fill_edges(pir_framed_body *body, uint32_t i) {
    const pir_compound *c = body->of;
    const pir_polytope *piece = c->piece[i];
    for (uint32_t e = 0; e < piece->edge_count; e++) {
        const uint32_t half = piece->edge_half[e], at = body->edge_start[i] + e;
        const pir_vec3 along = piece->direction[half];
        body->edge[at] = (pir_framed_edge){.left = c->face_start[i] + piece->arc_ends[e].from,
                                           .right = c->face_start[i] + piece->arc_ends[e].to,
                                           .origin = c->vertex_start[i] + piece->origin[half],
                                           .target = c->vertex_start[i] + piece->target[half]};
        body->edge[at].line = line_of(body, &body->edge[at]);
        body->edge[at].inner = pir_shared_features_inner_edge(&body->shared, body->shared.vertex[body->edge[at].origin],
                                                              body->shared.vertex[body->edge[at].target]);
        body->own_along[at][0] = along.x;
        body->own_along[at][1] = along.y;
        body->own_along[at][2] = along.z;
    }
}

static void finish_body(pir_framed_body *body, const pir_allocator *a) {
    const pir_compound *c = body->of;
    if (!c)
        return;
    const size_t edges = body->edge_start ? body->edge_start[c->count] : 0;
    PIR_FREE(a, body->edge, edges);
    PIR_FREE(a, (double *)body->vertex, 3 * (size_t)c->vertex_start[c->count]);
    PIR_FREE(a, (double *)body->normal, 3 * (size_t)c->face_start[c->count]);
    PIR_FREE(a, body->height, c->face_start[c->count]);
    PIR_FREE(a, (double *)body->along, 3 * edges);
    PIR_FREE(a, (double *)body->own_along, 3 * edges);
    PIR_FREE(a, body->box, c->count);
    PIR_FREE(a, (uint32_t *)body->line, 2 * edges);
    pir_shared_features_finish(&body->shared, c, a);
    PIR_FREE(a, body->edge_start, (size_t)c->count + 1);
}

bool pir_piece_frame_init(pir_piece_frame *frame, const pir_compound *p, const pir_compound *q,
                          const pir_allocator *allocator) {
    const pir_compound *const of[2] = {p, q};
    (void)frexp(p->reach + q->reach, &frame->exponent);
    frame->exponent += 3;
    for (int k = 0; k < 2; k++) {
        if (!reserve(&frame->body[k], of[k], allocator) ||
            !pir_shared_features_init(&frame->body[k].shared, of[k], allocator))
            return false;
        for (uint32_t i = 0; i < of[k]->count; i++)
            fill_edges(&frame->body[k], i);
        frame->rotation.integers = &frame->integers[0];
        frame->rotation_q.integers = &frame->integers[1];
    }
    return true;
}

void pir_piece_frame_finish(pir_piece_frame *frame, const pir_allocator *allocator) {
    for (int k = 0; k < 2; k++)
        finish_body(&frame->body[k], allocator);
}

/* --- doubles --- */

static void turn(const pir_mat3 *r, double sign, const double x[3], double ret[3]) {
    for (int i = 0; i < 3; i++)
        ret[i] = sign * (r->m[i][0] * x[0] + r->m[i][1] * x[1] + r->m[i][2] * x[2]);
}

static void box_piece(pir_framed_body *body, uint32_t i) {
    pir_space_box box = PIR_SPACE_BOX_EMPTY;
    for (uint32_t v = body->of->vertex_start[i]; v < body->of->vertex_start[i + 1]; v++)
        for (int k = 0; k < 3; k++) {
            box.low[k] = fmin(box.low[k], body->vertex[v][k] - 0x1p-48);
            box.high[k] = fmax(box.high[k], body->vertex[v][k] + 0x1p-48);
        }
    body->box[i] = box;
}

/* Every vector of a body in the frame: turned and reversed, or as it is where `r` is NULL. */
static void pose_body(pir_framed_body *body, const pir_mat3 *r, double unit) {
    static const pir_mat3 same = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const pir_compound *c = body->of;
    const double sign = r ? -1 : 1;
    const pir_mat3 *by = r ? r : &same;
    for (uint32_t v = 0; v < c->vertex_start[c->count]; v++)
        turn(by, sign * unit, c->vertex[v], body->vertex[v]);
    for (uint32_t f = 0; f < c->face_start[c->count]; f++) {
        turn(by, sign, c->face[f].normal, body->normal[f]);
        body->height[f] = unit * c->face[f].offset;
    }
    for (uint32_t e = 0; e < body->edge_start[c->count]; e++)
        turn(by, 1, body->own_along[e], body->along[e]);
    body->whole = PIR_SPACE_BOX_EMPTY;
    for (uint32_t i = 0; i < c->count; i++) {
        box_piece(body, i);
        for (int k = 0; k < 3; k++) {
            body->whole.low[k] = fmin(body->whole.low[k], body->box[i].low[k]);
            body->whole.high[k] = fmax(body->whole.high[k], body->box[i].high[k]);
        }
    }
}

pir_status pir_piece_frame_set(pir_piece_frame *frame, const pir_pair_input *input) {
    pir_status status = pir_rotation_set(&frame->rotation_q, input->pose_q.rotation);
    if (status == PIR_OK)
        status = pir_rotation_set_relative(&frame->rotation, input->pose_q.rotation, input->pose_p.rotation);
    if (status != PIR_OK)
        return status;
    frame->translation[0] = input->pose_p.translation;
    frame->translation[1] = input->pose_q.translation;
    const double unit = ldexp(1, -frame->exponent);
    pose_body(&frame->body[0], &frame->rotation.r, unit);
    pose_body(&frame->body[1], NULL, unit);
    const pir_vec3 way = pir_vec_sub(frame->translation[0], frame->translation[1]);
    const double x[3] = {unit * way.x, unit * way.y, unit * way.z};
    const pir_mat3 *r = &frame->rotation_q.r;
    for (int k = 0; k < 3; k++)
        frame->t[k] = r->m[0][k] * x[0] + r->m[1][k] * x[1] + r->m[2][k] * x[2];
    return PIR_OK;
}

pir_vec3 pir_piece_frame_to_world(const pir_piece_frame *frame, const double x[3]) {
    const double unit = ldexp(1, frame->exponent);
    const pir_vec3 v = {unit * x[0], unit * x[1], unit * x[2]};
    return pir_mat_apply(&frame->rotation_q.r, v);
}

/* --- exact numbers --- */

static void set_int(mpz_ptr to, const pir_int *a) {
    mpz_t view;
    mpz_set(to, mpz_roinit_n(view, a->limb, a->size));
}

static void multiply(mpz_ptr to, const pir_int *a) {
    mpz_t view;
    mpz_mul(to, to, mpz_roinit_n(view, a->limb, a->size));
}

/* ret = ±M·v, or ±v for B. */
static void turned(pir_piece_frame *frame, int side, const pir_int3 *v, int sign, mpz_t *ret) {
    for (int i = 0; i < 3; i++) {
        if (side == 1) {
            set_int(ret[i], &v->c[i]);
            continue;
        }
        mpz_set_ui(ret[i], 0);
        for (int k = 0; k < 3; k++) {
            mpz_t m, x;
            const pir_int *entry = &frame->integers[0].m[i][k];
            mpz_addmul(ret[i], mpz_roinit_n(m, entry->limb, entry->size), mpz_roinit_n(x, v->c[k].limb, v->c[k].size));
        }
        if (sign < 0)
            mpz_neg(ret[i], ret[i]);
    }
}

void pir_piece_frame_vertex(pir_piece_frame *frame, int side, uint32_t i, uint32_t v, mpz_t ret[4]) {
    const pir_polytope *piece = frame->body[side].of->piece[i];
    const pir_int3 at = pir_vectors_at(&piece->exact_vertex, v);
    pir_rotation_make_exact(&frame->rotation);
    turned(frame, side, &at, -1, ret);
    for (int k = 0; k < 3; k++)
        multiply(ret[k], &piece->scale.num);
    set_int(ret[3], &piece->scale.den);
    if (side == 0)
        multiply(ret[3], &frame->integers[0].norm);
}

void pir_piece_frame_normal(pir_piece_frame *frame, int side, uint32_t i, uint32_t face, mpz_t ret[3]) {
    const pir_int3 n = pir_vectors_at(&frame->body[side].of->piece[i]->exact_normal, face);
    pir_rotation_make_exact(&frame->rotation);
    turned(frame, side, &n, -1, ret);
}

void pir_piece_frame_along(pir_piece_frame *frame, int side, uint32_t i, uint32_t edge, mpz_t ret[3]) {
    const pir_int3 e = pir_vectors_at(&frame->body[side].of->piece[i]->exact_edge, edge);
    pir_rotation_make_exact(&frame->rotation);
    turned(frame, side, &e, 1, ret);
}

/* Three doubles as integers times 2^ret. */
static int set_doubles(const double x[3], mpz_t ret[3]) {
    int low = 0;
    bool any = false;
    for (int k = 0; k < 3; k++)
        if (x[k] != 0) {
            const int own = pir_double_low_bit(x[k]);
            low = !any || own < low ? own : low;
            any = true;
        }
    for (int k = 0; k < 3; k++) {
        int e;
        const double m = frexp(x[k], &e);
        mpz_set_d(ret[k], ldexp(m, 53));
        if (e - 53 >= low)
            mpz_mul_2exp(ret[k], ret[k], (mp_bitcnt_t)(e - 53 - low));
        else
            mpz_fdiv_q_2exp(ret[k], ret[k], (mp_bitcnt_t)(low - e + 53));
    }
    return low;
}

/* ret = Mᵀ of Q's rotation times x, over |q|², where x = ret · 2^low. */
static void turn_back(pir_piece_frame *frame, int low, mpz_t ret[4]) {
    mpz_t x[3];
    pir_rotation_make_exact(&frame->rotation_q);
    set_int(ret[3], &frame->integers[1].norm);
    for (int k = 0; k < 3; k++)
        mpz_init_set(x[k], ret[k]);
    for (int i = 0; i < 3; i++) {
        mpz_set_ui(ret[i], 0);
        for (int k = 0; k < 3; k++) {
            mpz_t m;
            const pir_int *entry = &frame->integers[1].m[k][i];
            mpz_addmul(ret[i], mpz_roinit_n(m, entry->limb, entry->size), x[k]);
        }
    }
    for (int k = 0; k < 3; k++)
        mpz_clear(x[k]);
    for (int i = 0; i < 3 && low > 0; i++)
        mpz_mul_2exp(ret[i], ret[i], (mp_bitcnt_t)low);
    if (low < 0)
        mpz_mul_2exp(ret[3], ret[3], (mp_bitcnt_t)-low);
}

void pir_piece_frame_turn_back(pir_piece_frame *frame, pir_vec3 way, mpz_t ret[4]) {
    turn_back(frame, set_doubles((const double[3]){way.x, way.y, way.z}, ret), ret);
}

void pir_piece_frame_translation(pir_piece_frame *frame, mpz_t ret[4]) {
    const pir_vec3 t = frame->translation[0], u = frame->translation[1];
    mpz_t other[3];
    for (int k = 0; k < 3; k++)
        mpz_init(other[k]);
    const int low = set_doubles((const double[3]){t.x, t.y, t.z}, ret);
    const int low_q = set_doubles((const double[3]){u.x, u.y, u.z}, other);
    const int least = low < low_q ? low : low_q;
    for (int k = 0; k < 3; k++) {
        mpz_mul_2exp(ret[k], ret[k], (mp_bitcnt_t)(low - least));
        mpz_mul_2exp(other[k], other[k], (mp_bitcnt_t)(low_q - least));
        mpz_sub(ret[k], ret[k], other[k]);
        mpz_clear(other[k]);
    }
    turn_back(frame, least, ret);
}
