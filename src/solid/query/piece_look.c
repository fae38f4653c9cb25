/* SPDX-License-Identifier: MIT */
/*
 * See piece_look.h. Vertices are within an ulp of the exact ones, normals within 2^-49 of the true ones, the turn
 * within 2^-48: every height over a plane is within 2^-45 of its value, times how far the bodies reach and coordinates
 * go. That a plane parts two pieces needs no more than their vertices: the normal may be any.
 */
#include "solid/query/piece_look.h"

#include "base/vec.h"

/* How many ways are tried: after so many a pair is asked in full. */
#define WAYS 4

static bool is_usual(double x) {
    return x > 0x1p-400 && x < 0x1p400;
}

static double norm(pir_quat q) {
    return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
}

bool pir_relative_is_plain(const pir_pair_input *input) {
    const pir_quat a = input->pose_p.rotation, b = input->pose_q.rotation;
    const pir_vec3 t = input->pose_p.translation, u = input->pose_q.translation;
    const double far = fabs(t.x) + fabs(t.y) + fabs(t.z) + fabs(u.x) + fabs(u.y) + fabs(u.z);
    return is_usual(norm(a)) && is_usual(norm(b)) && far < 0x1p400 && input->radius_p >= 0 && input->radius_q >= 0 &&
           input->radius_p + input->radius_q < 0x1p400 && !isnan(input->cutoff) && !isnan(input->margin);
}

/* The rotation as a quaternion of a usual size. */
static pir_quat usual(pir_quat q) {
    if (is_usual(norm(q)))
        return q;
    int exponent;
    (void)frexp(fmax(fmax(fabs(q.x), fabs(q.y)), fmax(fabs(q.z), fabs(q.w))), &exponent);
    return (pir_quat){ldexp(q.x, -exponent), ldexp(q.y, -exponent), ldexp(q.z, -exponent), ldexp(q.w, -exponent)};
}

static void set_turn(double turn[3][3], pir_quat r) {
    const double s = 2 / norm(r);
    turn[0][0] = 1 - s * (r.y * r.y + r.z * r.z);
    turn[0][1] = s * (r.x * r.y - r.z * r.w);
    turn[0][2] = s * (r.x * r.z + r.y * r.w);
    turn[1][0] = s * (r.x * r.y + r.z * r.w);
    turn[1][1] = 1 - s * (r.x * r.x + r.z * r.z);
    turn[1][2] = s * (r.y * r.z - r.x * r.w);
    turn[2][0] = s * (r.x * r.z - r.y * r.w);
    turn[2][1] = s * (r.y * r.z + r.x * r.w);
    turn[2][2] = 1 - s * (r.x * r.x + r.y * r.y);
}

pir_relative pir_relative_of(const pir_compound *p, const pir_compound *q, const pir_pair_input *input) {
    const pir_quat a = usual(input->pose_p.rotation), b = usual(input->pose_q.rotation);
    const pir_vec3 t = input->pose_p.translation, u = input->pose_q.translation;
    const double way[3] = {t.x - u.x, t.y - u.y, t.z - u.z};
    pir_relative made = {.radii = input->radius_p + input->radius_q};
    double back[3][3];
    set_turn(back, b);
    set_turn(made.turn,
             (pir_quat){b.w * a.x - b.x * a.w - b.y * a.z + b.z * a.y, b.w * a.y + b.x * a.z - b.y * a.w - b.z * a.x,
                        b.w * a.z - b.x * a.y + b.y * a.x - b.z * a.w, b.w * a.w + b.x * a.x + b.y * a.y + b.z * a.z});
    for (int i = 0; i < 3; i++) {
        made.shift[i] = back[0][i] * way[0] + back[1][i] * way[1] + back[2][i] * way[2];
        for (int k = 0; k < 3; k++)
            made.reach[i][k] = fabs(made.turn[i][k]);
    }
    made.error =
        0x1p-44 * (p->reach + q->reach + fabs(t.x) + fabs(t.y) + fabs(t.z) + fabs(u.x) + fabs(u.y) + fabs(u.z)) +
        0x1p-44 * made.radii;
    return made;
}

/* --- pieces --- */

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The vertex of a piece that is lowest along a direction of the body's frame. */
static uint32_t lowest_vertex(const pir_compound *c, uint32_t piece, const double n[3], double *ret_height) {
    const double(*v)[3] = (const double(*)[3])c->vertex;
    uint32_t at = c->vertex_start[piece];
    double low = dot(n, v[at]);
    for (uint32_t k = at + 1; k < c->vertex_start[piece + 1]; k++) {
        const double height = dot(n, v[k]);
        if (height < low) {
            low = height;
            at = k;
        }
    }
    *ret_height = low;
    return at;
}

/* Turns a normal of P's frame into Q's, or back. */
static void turn_normal(const pir_relative *relative, bool back, const double n[3], double ret[3]) {
    for (int i = 0; i < 3; i++)
        ret[i] = back ? relative->turn[0][i] * n[0] + relative->turn[1][i] * n[1] + relative->turn[2][i] * n[2]
                      : dot(relative->turn[i], n);
}

/* Holds piece `other` of one body against the faces of piece `own` of the other; `of_p` when that is P's. */
static pir_likely look(const pir_relative *relative, bool of_p, const pir_compound *a, uint32_t own,
                       const pir_compound *b, uint32_t other) {
    bool inside = true;
    for (uint32_t f = a->face_start[own]; f < a->face_start[own + 1]; f++) {
        double n[3];
        turn_normal(relative, !of_p, a->face[f].normal, n);
        // heights are those in the frame of `other`, less where the plane is there
        const double at = of_p ? a->face[f].offset + dot(n, relative->shift)
                               : a->face[f].offset - dot(a->face[f].normal, relative->shift);
        const double middle = dot(n, b->middle[other]) - at;
        inside = inside && middle < -relative->error;
        double low = -HUGE_VAL;
        if (middle > relative->error + relative->radii)
            lowest_vertex(b, other, n, &low);
        if (low - at > relative->error + relative->radii)
            return PIR_CERTAINLY_APART;
    }
    return inside ? PIR_CERTAINLY_INSIDE : PIR_LIKELY_UNKNOWN;
}

/* Whether a direction parts two pieces, of a few towards their nearest points: from the point v of P ⊖ Q at hand to
 * the vertex that is lowest along v, and on to where the origin is nearest between both (Gilbert 1966). */
static bool some_way_parts(const pir_relative *relative, const pir_compound *p, uint32_t i, const pir_compound *q,
                           uint32_t j) {
    double v[3], w[3], n[3], m[3], low_p, low_q;
    for (int k = 0; k < 3; k++)
        v[k] = relative->shift[k] + dot(relative->turn[k], p->middle[i]) - q->middle[j][k];
    for (int step = 0; step < WAYS; step++) {
        turn_normal(relative, true, v, n);
        for (int k = 0; k < 3; k++)
            m[k] = -v[k];
        const double *a = p->vertex[lowest_vertex(p, i, n, &low_p)], *b = q->vertex[lowest_vertex(q, j, m, &low_q)];
        const double length = dot(v, v), height = low_p + low_q + dot(v, relative->shift);
        if (height > (relative->error + relative->radii) * sqrt(length))
            return true;
        double way = 0;
        for (int k = 0; k < 3; k++) {
            w[k] = relative->shift[k] + dot(relative->turn[k], a) - b[k] - v[k];
            way += w[k] * w[k];
        }
        const double part = -dot(v, w) / way;
        if (!(part > 0x1p-20))
            return false;
        for (int k = 0; k < 3; k++)
            v[k] += (part < 1 ? part : 1) * w[k];
    }
    return false;
}

pir_likely pir_pieces_look(const pir_relative *relative, const pir_compound *p, uint32_t i, const pir_compound *q,
                           uint32_t j) {
    if (some_way_parts(relative, p, i, q, j))
        return PIR_CERTAINLY_APART;
    const pir_likely first = look(relative, false, q, j, p, i);
    return first == PIR_LIKELY_UNKNOWN ? look(relative, true, p, i, q, j) : first;
}
