/* SPDX-License-Identifier: MIT */
/*
 * Pairs of triangles: a direction rules out most of them by six dot products; of the rest the span is computed
 * (triangle_span.h). Of two pairs whose spans overlap the same features say that they are as near, else exact squares
 * decide.
 */
#include "mesh/pair/leaf_pair.h"

/* --- the best --- */

bool pir_best_pair_reserve(pir_best_pair *best, const pir_allocator *allocator, uint32_t coordinate) {
    uint32_t room = PIR_EXACT_SQUARE_LIMBS(coordinate);
    if (room <= best->room)
        return true;
    mp_limb_t *limbs = PIR_RESIZE(allocator, best->limbs, 4 * (size_t)best->room, 4 * (size_t)room);
    if (!limbs)
        return false;
    best->limbs = limbs;
    best->room = room;
    best->has_square = false;
    pir_int *parts[4] = {&best->square.num, &best->square.den, &best->other.num, &best->other.den};
    for (int i = 0; i < 4; i++)
        *parts[i] = (pir_int){limbs + (size_t)i * room, 0, room};
    return true;
}

void pir_best_pair_finish(pir_best_pair *best, const pir_allocator *allocator) {
    PIR_FREE(allocator, best->limbs, 4 * (size_t)best->room);
}

void pir_best_pair_clear(pir_best_pair *best) {
    best->p = best->q = PIR_TRIANGLE_NONE;
    best->has_square = best->meets = best->has_compared = false;
}

pir_corners pir_frame_corners(const pir_mesh_frame *frame, int side, uint32_t triangle) {
    const pir_trimesh *mesh = frame->mesh[side];
    pir_corners corners = {.count = 3};
    for (int k = 0; k < 3; k++) {
        uint32_t v = mesh->corner[triangle][k];
        corners.id[k] = v;
        corners.p[k] = side == 0 ? pir_mesh_frame_apply(frame, mesh->vertex[v]) : mesh->vertex[v];
    }
    return corners;
}

static bool is_lower(const pir_best_pair *best, uint32_t p, uint32_t q) {
    return p < best->p || (p == best->p && q < best->q);
}

/* Takes a pair for the best. Whether it meets is decided at once, for then only numbers count. */
static void take(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q, const pir_span *span) {
    best->p = p;
    best->q = q;
    best->span = *span;
    best->meets = span->meets;
    best->has_square = best->has_compared = false;
    if (span->low > 0 || span->meets)
        return;
    pir_mesh_frame_square(frame, p, q, &best->square);
    best->has_square = true;
    best->meets = best->square.num.size == 0;
    if (best->meets)
        best->span.high = 0;
}

/* The sign of the distance of a pair less that of the best, exactly. */
static int exact_order(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q,
                       pir_trimesh_pair_statistics *counts) {
    counts->exact++;
    if (!best->has_square)
        pir_mesh_frame_square(frame, best->p, best->q, &best->square);
    best->has_square = true;
    pir_mesh_frame_square(frame, p, q, &best->other);
    return pir_exact_square_order(&frame->limbs, &best->other, &best->square);
}

/* The sign of the distance of a pair less that of the best, whose spans overlap. */
static int order_of(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q, const pir_span *span,
                    pir_trimesh_pair_statistics *counts) {
    if (span->meets)
        return best->meets ? 0 : -1;
    if (pir_same_features(span, &best->span))
        return 0;
    if (!best->meets) {
        // of many pairs that share their features one is compared
        if (!best->has_compared || !pir_same_features(span, &best->compared))
            best->order = exact_order(best, frame, p, q, counts);
        best->has_compared = true;
        best->compared = *span;
        return best->order;
    }
    counts->exact++;
    pir_mesh_frame_square(frame, p, q, &best->other);
    return best->other.num.size == 0 ? 0 : 1;
}

void pir_best_pair_consider(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q, const pir_span *span,
                            pir_trimesh_pair_statistics *counts) {
    if (best->p == PIR_TRIANGLE_NONE || span->high < best->span.low) {
        take(best, frame, p, q, span);
        return;
    }
    if (span->low > best->span.high || (best->meets && (span->low > 0 || !is_lower(best, p, q))))
        return;
    int order = order_of(best, frame, p, q, span, counts);
    if (order < 0 || (order == 0 && is_lower(best, p, q)))
        take(best, frame, p, q, span);
}

void pir_best_pair_begin(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q,
                         pir_trimesh_pair_statistics *counts) {
    pir_corners a = pir_frame_corners(frame, 0, p), b = pir_frame_corners(frame, 1, q);
    pir_span span = pir_triangle_span(&a, &b, frame->error);
    counts->triangles++;
    take(best, frame, p, q, &span);
}

/* --- leaves --- */

/* The triangles of a leaf in Q's frame; those of P are brought there when they are first needed. */
struct leaf {
    uint32_t count, number[PIR_MESH_LEAF];
    bool placed[PIR_MESH_LEAF];
    pir_corners corners[PIR_MESH_LEAF];
    double end[PIR_MESH_LEAF]; /* along the direction tried: the least of P's, the greatest of Q's */
};

/* The leaf of a side; n is the direction as that mesh sees it. */
static void fill_leaf(const pir_mesh_frame *frame, int side, uint32_t leaf, pir_vec3 n, struct leaf *ret) {
    const pir_trimesh *mesh = frame->mesh[side];
    uint32_t start = pir_mesh_leaf_start(leaf);
    ret->count = pir_mesh_leaf_count(leaf);
    for (uint32_t i = 0; i < ret->count; i++) {
        ret->number[i] = mesh->tree.item[start + i];
        ret->placed[i] = false;
        const uint32_t *corner = mesh->corner[ret->number[i]];
        double a = pir_vec_dot(n, mesh->vertex[corner[0]]), b = pir_vec_dot(n, mesh->vertex[corner[1]]);
        double c = pir_vec_dot(n, mesh->vertex[corner[2]]);
        double low = a < b ? a : b, high = a > b ? a : b;
        ret->end[i] = side == 0 ? (c < low ? c : low) : c > high ? c : high;
    }
}

static const pir_corners *corners_of(const pir_mesh_frame *frame, int side, struct leaf *leaf, uint32_t i) {
    if (!leaf->placed[i])
        leaf->corners[i] = pir_frame_corners(frame, side, leaf->number[i]);
    leaf->placed[i] = true;
    return &leaf->corners[i];
}

/* The shortest of the lengths that two triangles are known to be apart, and how. */
struct least {
    double low;
    pir_vec3 n;
};

/* The corner that a direction reaches first. */
static pir_vec3 support(const pir_corners *c, pir_vec3 n) {
    double x = pir_vec_dot(n, c->p[0]), y = pir_vec_dot(n, c->p[1]), z = pir_vec_dot(n, c->p[2]);
    return x < y ? (x < z ? c->p[0] : c->p[2]) : y < z ? c->p[1] : c->p[2];
}

/* Directions that are tried before the span is computed. */
#define TRIES 5

/*
 * A lower bound on the distance of two triangles, as soon as it is above `enough`: differences of points, each the
 * nearest to the origin on the way from the one before to that which it reaches first (Gilbert, SIAM J. Control 4(1),
 * 1966). *n is the direction of the greatest.
 */
static double gap_of(const pir_corners *a, const pir_corners *b, double enough, double error, pir_vec3 *n) {
    double best = -HUGE_VAL;
    pir_vec3 v = *n;
    for (int i = 0; i < TRIES; i++) {
        pir_vec3 w = pir_vec_sub(support(a, v), support(b, pir_vec_scale(v, -1)));
        double square = pir_vec_dot(v, v), gap = pir_vec_dot(v, w) / sqrt(square) * (1 - 0x1p-48) - 16 * error;
        if (gap > best) {
            best = gap;
            *n = v;
        }
        if (gap > enough || !(square > 0))
            break;
        // a direction given is no point of the difference, which the first one reaches
        pir_vec3 e = pir_vec_sub(w, v);
        double along = -pir_vec_dot(v, e), length = pir_vec_dot(e, e);
        v = i == 0 || along >= length ? w : pir_vec_add(v, pir_vec_scale(e, along > 0 ? along / length : 0));
    }
    return best;
}

static void consider_pair(pir_best_pair *best, pir_mesh_frame *frame, uint32_t p, uint32_t q,
                          const pir_corners *const corners[2], struct least *least,
                          pir_trimesh_pair_statistics *counts) {
    pir_vec3 n = least->n;
    if (best->p != PIR_TRIANGLE_NONE) {
        double gap = gap_of(corners[0], corners[1], best->span.high, frame->error, &n);
        if (gap > best->span.high) {
            *least = gap < least->low ? (struct least){gap, n} : *least;
            return;
        }
    }
    counts->triangles++;
    pir_span span = pir_triangle_span(corners[0], corners[1], frame->error);
    if (span.low < least->low)
        *least = (struct least){span.low, pir_vec_sub(span.point_a, span.point_b)};
    pir_best_pair_consider(best, frame, p, q, &span, counts);
}

/* How far a direction takes all triangles of two leaves apart. */
static double leaf_gap(const pir_mesh_frame *frame, const struct leaf *a, const struct leaf *b, pir_vec3 n) {
    double low = HUGE_VAL, high = -HUGE_VAL, length = sqrt(pir_vec_dot(n, n));
    for (uint32_t i = 0; i < a->count; i++)
        low = a->end[i] < low ? a->end[i] : low;
    for (uint32_t j = 0; j < b->count; j++)
        high = b->end[j] > high ? b->end[j] : high;
    return (low + pir_vec_dot(n, frame->t) - high) / length - 16 * frame->error;
}

static void fill_leaves(const pir_mesh_frame *frame, const uint32_t leaf[2], pir_vec3 n, struct leaf *a,
                        struct leaf *b) {
    fill_leaf(frame, 0, leaf[0], pir_mat_apply_transposed(&frame->r, n), a);
    fill_leaf(frame, 1, leaf[1], n, b);
}

/* The vertex of a leaf that is the farthest along n, in the mesh's own frame. */
static pir_vec3 leaf_support(const pir_trimesh *mesh, uint32_t leaf, pir_vec3 n) {
    uint32_t start = pir_mesh_leaf_start(leaf), end = start + pir_mesh_leaf_count(leaf), best = 0;
    double most = -HUGE_VAL;
    for (uint32_t i = start; i < end; i++) {
        const uint32_t *corner = mesh->corner[mesh->tree.item[i]];
        for (int k = 0; k < 3; k++) {
            double along = pir_vec_dot(n, mesh->vertex[corner[k]]);
            best = along > most ? corner[k] : best;
            most = along > most ? along : most;
        }
    }
    return mesh->vertex[best];
}

/* Directions that are tried for leaves as a whole. */
#define LEAF_TRIES 4

/* Whether a direction takes two leaves apart by more than a distance; *ret_gap is by how much. As in gap_of. */
static bool leaves_are_far(const pir_mesh_frame *frame, const uint32_t leaf[2], double distance, pir_vec3 *n,
                           double *ret_gap) {
    pir_vec3 v = *n;
    for (int i = 0; i < LEAF_TRIES; i++) {
        pir_vec3 towards = pir_vec_scale(pir_mat_apply_transposed(&frame->r, v), -1);
        pir_vec3 x = pir_mesh_frame_apply(frame, leaf_support(frame->mesh[0], leaf[0], towards));
        pir_vec3 w = pir_vec_sub(x, leaf_support(frame->mesh[1], leaf[1], v)), e = pir_vec_sub(w, v);
        double square = pir_vec_dot(v, v);
        *ret_gap = pir_vec_dot(v, w) / sqrt(square) * (1 - 0x1p-48) - 16 * frame->error;
        if (*ret_gap > distance) {
            *n = v;
            return true;
        }
        double along = -pir_vec_dot(v, e), length = pir_vec_dot(e, e);
        v = i == 0 || along >= length ? w : pir_vec_add(v, pir_vec_scale(e, along > 0 ? along / length : 0));
        if (!(pir_vec_dot(v, v) > 0))
            break;
    }
    return false;
}

double pir_leaf_pair_consider(pir_best_pair *best, pir_mesh_frame *frame, const uint32_t leaf[2], pir_vec3 *n,
                              double *ret_gap, pir_trimesh_pair_statistics *counts) {
    if (best->p != PIR_TRIANGLE_NONE && !best->meets && leaves_are_far(frame, leaf, best->span.high, n, ret_gap))
        return *ret_gap;
    struct leaf a, b;
    fill_leaves(frame, leaf, *n, &a, &b);
    double length = sqrt(pir_vec_dot(*n, *n)), by = length > 0 ? (1 - 0x1p-48) / length : 0;
    double moved = pir_vec_dot(*n, frame->t);
    struct least least = {HUGE_VAL, *n};
    for (uint32_t i = 0; i < a.count; i++)
        for (uint32_t j = 0; j < b.count; j++) {
            double gap = (a.end[i] + moved - b.end[j]) * by - 16 * frame->error;
            bool known = best->p != PIR_TRIANGLE_NONE &&
                         (gap > best->span.high || (best->meets && !is_lower(best, a.number[i], b.number[j])));
            const pir_corners *const corners[2] = {known ? NULL : corners_of(frame, 0, &a, i),
                                                   known ? NULL : corners_of(frame, 1, &b, j)};
            if (!known)
                consider_pair(best, frame, a.number[i], b.number[j], corners, &least, counts);
            else if (gap < least.low)
                least = (struct least){gap, *n};
        }
    if (pir_vec_dot(least.n, least.n) > 0 && (least.n.x != n->x || least.n.y != n->y || least.n.z != n->z)) {
        *n = least.n;
        fill_leaves(frame, leaf, *n, &a, &b);
    }
    *ret_gap = leaf_gap(frame, &a, &b, *n);
    return least.low > 0 ? least.low : 0;
}

void pir_leaf_pair_visit(const pir_mesh_frame *frame, const uint32_t leaf[2], pir_vec3 n, double distance,
                         pir_near_triangles *visit, void *context) {
    double apart;
    if (leaves_are_far(frame, leaf, distance, &n, &apart))
        return;
    struct leaf a, b;
    fill_leaves(frame, leaf, n, &a, &b);
    double length = sqrt(pir_vec_dot(n, n)), by = length > 0 ? (1 - 0x1p-48) / length : 0;
    double moved = pir_vec_dot(n, frame->t);
    for (uint32_t i = 0; i < a.count; i++)
        for (uint32_t j = 0; j < b.count; j++) {
            if ((a.end[i] + moved - b.end[j]) * by - 16 * frame->error > distance)
                continue;
            const pir_corners *p = corners_of(frame, 0, &a, i), *q = corners_of(frame, 1, &b, j);
            pir_vec3 direction = n;
            if (gap_of(p, q, distance, frame->error, &direction) <= distance)
                visit(context, a.number[i], b.number[j], (const pir_corners *const[2]){p, q});
        }
}
