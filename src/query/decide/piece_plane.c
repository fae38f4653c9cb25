/* SPDX-License-Identifier: MIT */
/* Planes of pieces: see piece_plane.h. */
#include "query/decide/piece_plane.h"

#include "query/decide/placed.h"

bool pir_plane_of_edges(pir_exact *exact, pir_piece piece, pir_plane *ret_plane) {
    const pir_frame *frame = exact->frame;
    const pir_polytope *p = frame->p.polytope, *q = frame->q.polytope;
    uint32_t half = p->edge_half[piece.first], h = piece.second;
    pir_vec3 n = pir_vec_cross(q->direction[h], pir_mat_apply(&frame->r, p->direction[half]));
    double square = pir_vec_dot(n, n);
    if (square < PIR_SIN_EXACT * PIR_SIN_EXACT) {
        *ret_plane = (pir_plane){.err = 1 / PIR_SIN_EXACT, .piece = piece};
        return pir_plane_refine(exact, ret_plane);
    }
    double err = 1 / sqrt(square);
    n = pir_vec_scale(n, err);
    *ret_plane = (pir_plane){n, pir_vec_dot(n, pir_frame_vertex(frame, p->origin[half], q->origin[h])), err, piece};
    return true;
}

bool pir_plane_of(pir_exact *exact, pir_piece piece, pir_plane *ret_plane) {
    const pir_frame *frame = exact->frame;
    if (piece.kind == PIR_FACET_EE)
        return pir_plane_of_edges(exact, piece, ret_plane);
    pir_vec3 n;
    double h;
    if (piece.kind == PIR_FACET_FV) {
        n = pir_mat_apply(&frame->r, frame->p.polytope->normal[piece.first]);
        h = frame->p.offset[piece.first] + pir_vec_dot(n, frame->q.vertex[piece.second]);
    } else {
        n = frame->q.polytope->normal[piece.second];
        h = frame->q.offset[piece.second] + pir_vec_dot(n, pir_mat_apply(&frame->r, frame->p.vertex[piece.first]));
    }
    *ret_plane = (pir_plane){n, h, 1, piece};
    return true;
}

bool pir_plane_refine(pir_exact *exact, pir_plane *plane) {
    if (plane->err * PIR_SIN_REFINED < 1)
        return true;
    if (!pir_side_normal(exact, plane->piece, &plane->n))
        return false;
    uint32_t a, b;
    pir_piece_corner(exact->frame, plane->piece, &a, &b);
    plane->h = pir_vec_dot(plane->n, pir_frame_vertex(exact->frame, a, b));
    plane->err = 1;
    return true;
}

/* --- in parallel arrays --- */

static pir_layout layout_of(pir_planes *planes) {
    return (pir_layout){{PIR_ROWS_LANES(planes->n, planes->capacity), PIR_ROW_LANE(planes->h, planes->capacity),
                         PIR_ROW_LANE(planes->err, planes->capacity), PIR_ROW(planes->piece, planes->capacity)}};
}

void pir_planes_finish(pir_planes *planes, const pir_allocator *allocator) {
    pir_layout layout = layout_of(planes);
    pir_layout_free(allocator, &layout);
}

bool pir_planes_resize(pir_planes *planes, const pir_allocator *allocator, uint32_t capacity) {
    pir_planes fresh = {.capacity = capacity};
    pir_layout layout = layout_of(&fresh);
    bool done = pir_layout_new(allocator, &layout);
    pir_planes_finish(done ? planes : &fresh, allocator);
    if (done)
        *planes = fresh;
    return done;
}
