/* SPDX-License-Identifier: MIT */
/*
 * Growing patches, and finding the points of their surfaces.
 *
 * Whether an edge is flat is its angle with one plane, not with its neighbour. So a patch does not grow around a
 * finely faceted body. Along any line across a patch the surface is concave: it rises and falls by no more than
 * PIR_FLAT of the way from vertex to vertex.
 */
#include "base/processor.h"
#include "query/contact/single.h"

/* --- room --- */

/* The most corners that pir_outline_overlap finds. */
static size_t most_shared(size_t of_p, size_t of_q) {
    return 2 * of_p + of_q + 4;
}

static pir_layout layout_of(pir_patch_room *room) {
    size_t of_p = room->of_p, of_q = room->of_q, shared = most_shared(of_p, of_q);
    return (pir_layout){{PIR_ROW(room->p.member, of_p), PIR_ROW(room->p.is_member, of_p), PIR_ROW(room->p.corner, of_p),
                         PIR_ROW(room->q.member, of_q), PIR_ROW(room->q.is_member, of_q), PIR_ROW(room->q.corner, of_q),
                         PIR_ROW(room->shared, shared), PIR_ROW(room->hull, shared + 1)}};
}

bool pir_patch_room_grow(pir_patch_room *room, const pir_allocator *allocator, size_t of_p, size_t of_q) {
    const pir_single_version *version = pir_processor_best()->single;
    pir_patch_room grown = {.p = {.version = version},
                            .q = {.version = version},
                            .of_p = of_p > room->of_p ? of_p : room->of_p,
                            .of_q = of_q > room->of_q ? of_q : room->of_q};
    pir_layout layout = layout_of(&grown);
    if (!pir_layout_new(allocator, &layout))
        return false;
    pir_patch_room_finish(room, allocator);
    *room = grown;
    return true;
}

void pir_patch_room_finish(pir_patch_room *room, const pir_allocator *allocator) {
    pir_layout layout = layout_of(room);
    pir_layout_free(allocator, &layout);
}

/* --- the body as it stands --- */

static pir_vec3 normal_of(const pir_patch *patch, uint32_t f) {
    pir_vec3 n = patch->polytope->normal[f];
    if (patch->r)
        n = pir_mat_apply(patch->r, n);
    return pir_vec_scale(n, patch->sign);
}

/* --- growing --- */

static void add(pir_patch *patch, uint32_t v) {
    if (patch->is_member[v])
        return;
    patch->is_member[v] = true;
    patch->member[patch->members++] = v;
}

static void add_facet(pir_patch *patch, uint32_t f) {
    const pir_polytope *p = patch->polytope;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        add(patch, p->origin[p->loop[i]]);
}

/* Adds every vertex that a member leads to along edges that are nearly across m. */
static void spread(pir_patch *patch, pir_vec3 m) {
    const pir_polytope *p = patch->polytope;
    m = pir_patch_to_body(patch, m);
    for (uint32_t i = 0; i < patch->members; i++) {
        uint32_t v = patch->member[i];
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
            if (fabs(pir_vec_dot(m, p->direction[h])) <= PIR_FLAT)
                add(patch, p->target[h]);
        }
    }
}

static bool leads_away(const pir_patch *patch, uint32_t f) {
    const pir_polytope *p = patch->polytope;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        if (!patch->is_member[p->origin[p->loop[i]]])
            return true;
    return false;
}

/*
 * The facet that faces `out` most, of those at members, or with `away` of those that have a vertex which is no
 * member. PIR_NO_FACET where all of them are steep or face away.
 */
static uint32_t facet_out(const pir_patch *patch, bool away) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    uint32_t best = PIR_NO_FACET;
    double most = PIR_STEEP;
    if (p->artificial)
        return best;
    for (uint32_t i = 0; i < patch->members; i++) {
        uint32_t v = patch->member[i];
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
            double along = pir_vec_dot(p->normal[p->left[h]], out);
            if (along > most && (!away || leads_away(patch, p->left[h]))) {
                most = along;
                best = p->left[h];
            }
        }
    }
    return best;
}

void pir_patch_grow(pir_patch *patch, pir_feature feature) {
    const pir_polytope *p = patch->polytope;
    patch->members = 0;
    if (feature.kind == PIR_FEATURE_VERTEX) {
        add(patch, feature.index);
    } else if (feature.kind == PIR_FEATURE_EDGE) {
        add(patch, p->origin[p->edge_half[feature.index]]);
        add(patch, p->target[p->edge_half[feature.index]]);
    } else {
        add_facet(patch, feature.index);
    }
    spread(patch, patch->out);
    patch->facet = facet_out(patch, false);
}

/*
 * The end of the edge that falls least from `out`, of the edges from members to other vertices. UINT32_MAX where all
 * of them are steep.
 */
static uint32_t flattest(const pir_patch *patch) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 out = pir_patch_to_body(patch, patch->out);
    uint32_t best = UINT32_MAX;
    double most = -HUGE_VAL;
    for (uint32_t i = 0; i < patch->members; i++) {
        uint32_t v = patch->member[i];
        for (uint32_t h = p->ring_start[v]; h < p->ring_start[v + 1]; h++) {
            double along = pir_vec_dot(p->direction[h], out);
            if (!patch->is_member[p->target[h]] && along > most) {
                most = along;
                best = p->target[h];
            }
        }
    }
    return most > PIR_STEEP - 1 ? best : UINT32_MAX;
}

bool pir_patch_extend(pir_patch *patch) {
    uint32_t f = facet_out(patch, true);
    if (f != PIR_NO_FACET) {
        patch->facet = f;
        add_facet(patch, f);
        spread(patch, normal_of(patch, f));
        return true;
    }
    uint32_t v = patch->facet == PIR_NO_FACET && patch->members == 1 ? flattest(patch) : UINT32_MAX;
    if (v != UINT32_MAX)
        add(patch, v);
    return v != UINT32_MAX;
}

bool pir_patch_complete(pir_patch *patch) {
    if (patch->facet == PIR_NO_FACET)
        return false;
    pir_vec3 n = normal_of(patch, patch->facet);
    double along = pir_vec_dot(n, patch->out);
    // edges of a facet that is tilted by no more than that are flat, so it is whole
    if (1 - along * along <= PIR_FLAT * PIR_FLAT)
        return false;
    uint32_t members = patch->members;
    add_facet(patch, patch->facet);
    spread(patch, n);
    return patch->members > members;
}

void pir_patch_clear(pir_patch *patch) {
    for (uint32_t i = 0; i < patch->members; i++)
        patch->is_member[patch->member[i]] = false;
    patch->members = 0;
}

/* --- the outline --- */

void pir_patch_set_outline(pir_patch *patch, const pir_vec3 axis[2], pir_corner *room) {
    for (uint32_t i = 0; i < patch->members; i++)
        patch->corner[i] = pir_patch_corner(patch, patch->member[i], axis);
    uint32_t count = pir_outline_hull(patch->corner, patch->members, patch->snap, room);
    patch->outline = (pir_outline){patch->corner, pir_outline_slim(patch->corner, count, PIR_FLUSH)};
}

/* --- the surface --- */

/*
 * The plane of a facet. A facet at 60° or more to the patch's first facet bounds the patch, and so does a steep one.
 * Rounding and merging may put a corner of the patch's rim beside it, so its plane is moved out by as much as they may.
 * Then a point over the patch is never beside it by rounding alone, and one that is beside it belongs on it, however
 * steep it is: on a needle such facets are wider than rounding.
 */
static inline pir_patch_plane plane_of(const pir_patch *patch, uint32_t f) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 n = normal_of(patch, f);
    double along = pir_vec_dot(n, patch->out);
    bool bounds = along < PIR_STEEP || 2 * pir_vec_dot(p->normal[f], p->normal[patch->facet]) < 1;
    pir_vec3 from = pir_patch_vertex(patch, p->origin[p->loop[p->loop_start[f]]]);
    return (pir_patch_plane){f, n, from, along, bounds ? PIR_OVER * patch->snap : 0};
}

/* The distance of x from a plane along `out`, or HUGE_VAL where its facet faces away. */
static inline double height(const pir_patch_plane *plane, pir_vec3 x) {
    if (plane->along <= 0)
        return HUGE_VAL;
    return (pir_vec_dot(plane->n, pir_vec_sub(plane->from, x)) + plane->more) / plane->along;
}

void pir_patch_look_around(pir_patch *patch) {
    const pir_polytope *p = patch->polytope;
    uint32_t f = patch->facet;
    patch->planes = 0;
    patch->is_split = false;
    if (f == PIR_NO_FACET || p->loop_start[f + 1] - p->loop_start[f] >= PIR_PATCH_PLANES)
        return;
    patch->plane[patch->planes++] = plane_of(patch, f);
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        pir_patch_plane beside = plane_of(patch, pir_right(p, p->loop[i]));
        patch->is_split |= pir_vec_dot(beside.n, patch->plane[0].n) > PIR_LEVEL_COSINE;
        // none is lower than one that faces away
        if (beside.along > 0)
            patch->plane[patch->planes++] = beside;
    }
}

/* Of the sides of a facet, the one that a point of its plane, in the body's frame, is farthest beyond; or none. */
static uint32_t side_passed(const pir_patch *patch, uint32_t f, pir_vec3 x) {
    const pir_polytope *p = patch->polytope;
    uint32_t side = UINT32_MAX;
    double most = -PIR_OVER * patch->snap;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t h = p->loop[i];
        pir_vec3 in = pir_vec_cross(p->normal[f], p->direction[h]);
        double within = pir_vec_dot(in, pir_vec_sub(x, patch->vertex[p->origin[h]]));
        side = within < most ? h : side;
        most = within < most ? within : most;
    }
    return side;
}

/*
 * Goes on from a facet that x is beyond a side of to what is lower. The facet across the side is not lower for certain
 * where both are coplanar but for rounding.
 */
static uint32_t pass_split(const pir_patch *patch, pir_vec3 x, uint32_t f, double *least) {
    const pir_polytope *p = patch->polytope;
    uint32_t best = f;
    for (uint32_t left = p->facet_count; left > 0; left--) {
        const pir_patch_plane plane = plane_of(patch, f);
        pir_vec3 at = pir_vec_add(x, pir_vec_scale(patch->out, height(&plane, x)));
        uint32_t side = side_passed(patch, f, pir_patch_to_body(patch, pir_vec_sub(at, patch->at)));
        if (side == UINT32_MAX)
            break;
        f = pir_right(p, side);
        const pir_patch_plane beside = plane_of(patch, f);
        if (beside.along <= 0)
            break;
        double h = height(&beside, x);
        best = h < *least ? f : best;
        *least = h < *least ? h : *least;
    }
    return best;
}

/* The facet over or under x, found from the patch's first facet, and how far x is from it along `out`. */
static inline uint32_t facet_over(const pir_patch *patch, pir_vec3 x, double *ret_height) {
    const pir_polytope *p = patch->polytope;
    // the surface is the least of its planes: go from facet to facet until no neighbour is lower
    uint32_t f = patch->facet;
    bool lower = patch->planes == 0;
    const pir_patch_plane first = lower ? plane_of(patch, f) : patch->plane[0];
    double least = height(&first, x);
    for (uint32_t i = 1; i < patch->planes; i++) {
        double h = height(&patch->plane[i], x);
        if (h < least) {
            least = h;
            f = patch->plane[i].facet;
            lower = true;
        }
    }
    while (lower) {
        lower = false;
        uint32_t here = f;
        for (uint32_t i = p->loop_start[here]; i < p->loop_start[here + 1]; i++) {
            const pir_patch_plane beside = plane_of(patch, pir_right(p, p->loop[i]));
            double h = height(&beside, x);
            if (h < least) {
                least = h;
                f = beside.facet;
                lower = true;
            }
        }
    }
    if (patch->planes == 0 || patch->is_split)
        f = pass_split(patch, x, f, &least);
    *ret_height = least;
    return f;
}

pir_vec3 pir_patch_lift(const pir_patch *patch, pir_vec3 x) {
    double height = 0;
    if (patch->facet == PIR_NO_FACET)
        return x;
    facet_over(patch, x, &height);
    return pir_vec_add(x, pir_vec_scale(patch->out, height));
}

/* The distance of x from the segment of a halfedge, in the body's own frame. */
static double off_side(const pir_patch *patch, uint32_t h, pir_vec3 x) {
    const pir_polytope *p = patch->polytope;
    pir_vec3 a = patch->vertex[p->origin[h]], way = pir_vec_sub(patch->vertex[p->target[h]], a),
             off = pir_vec_sub(x, a);
    double part = fmin(1, fmax(0, pir_vec_dot(off, way) / pir_vec_dot(way, way)));
    off = pir_vec_sub(off, pir_vec_scale(way, part));
    return sqrt(pir_vec_dot(off, off));
}

/* The distance from a facet of a point of its plane, in the body's own frame. */
static double off_facet(const pir_patch *patch, uint32_t f, pir_vec3 x) {
    const pir_polytope *p = patch->polytope;
    bool inside = true;
    double least = HUGE_VAL;
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t h = p->loop[i];
        pir_vec3 in = pir_vec_cross(p->normal[f], p->direction[h]);
        inside &= pir_vec_dot(in, pir_vec_sub(x, patch->vertex[p->origin[h]])) >= 0;
        least = fmin(least, off_side(patch, h, x));
    }
    return inside ? 0 : least;
}

bool pir_patch_find(const pir_patch *patch, pir_vec3 x, pir_vec3 *ret_point) {
    double unused;
    if (patch->facet == PIR_NO_FACET)
        return false;
    uint32_t f = facet_over(patch, x, &unused);
    pir_patch_plane plane = plane_of(patch, f);
    if (plane.along < PIR_LEAST_COSINE)
        return false;
    // on the facet itself: the plane may be moved out
    plane.more = 0;
    pir_vec3 point = pir_vec_add(x, pir_vec_scale(patch->out, height(&plane, x)));
    if (off_facet(patch, f, pir_patch_to_body(patch, pir_vec_sub(point, patch->at))) > PIR_OVER * patch->snap)
        return false;
    *ret_point = point;
    return true;
}

pir_vec3 pir_patch_side(const pir_patch *patch, uint32_t side, double t) {
    uint32_t end = side + 1 < patch->outline.count ? side + 1 : 0;
    pir_vec3 a = pir_patch_vertex(patch, patch->outline.at[side].p),
             b = pir_patch_vertex(patch, patch->outline.at[end].p);
    // a side of the outline is an edge, or nearly: the hull may have cut a corner
    return pir_patch_lift(patch, pir_vec_add(a, pir_vec_scale(pir_vec_sub(b, a), t)));
}
