/* SPDX-License-Identifier: MIT */
/*
 * Walking the arcs of a polytope's Gaussian map through the faces of the cube, on the sphere.
 *
 * A cube face is a convex cell there. The great circle of an arc, with the line's positive side on its left, leaves a
 * cell through the side whose start is right of it and whose end is left of it, or through the corner before which that
 * changes. The arc's end is inside when it is left of that side. An arc is no longer than 180°, so no point of the
 * circle beyond the antipode is taken for its end. Every predicate is the sign of a normal with a cube plane or of an
 * edge vector with a cube corner.
 *
 * A segment's map is a whole great circle without a normal on it: it is walked as two halves between opposite points on
 * cube edges.
 */
#include "cgm/arcs.h"

/* --- sites --- */

static uint32_t add_site(struct pir_cgm_arcs *arcs, struct pir_site site) {
    void *block = arcs->site;
    bool done = pir_cgm_grow(&arcs->allocator, &block, &arcs->site_capacity, arcs->site_count + 1, sizeof *arcs->site);
    arcs->site = block;
    if (!done)
        return PIR_CGM_NONE;
    arcs->site[arcs->site_count] = site;
    return arcs->site_count++;
}

/* The sign of a point at one side of a map, from its signs at the planes. */
static int at_side(const int8_t planes[PIR_CUBE_PLANES], uint32_t map, uint32_t side) {
    uint32_t line = pir_side_line(map, side);
    return line & 1 ? -planes[line >> 1] : planes[line >> 1];
}

/* Finds where on the cube a point is from its signs at the planes: place, map, cube edge; the corner's site is
   returned, or PIR_CGM_NONE. */
static uint32_t locate(const struct pir_cgm_arcs *arcs, const int8_t planes[PIR_CUBE_PLANES], struct pir_site *site) {
    for (uint32_t map = 0; map < 6; map++) {
        uint32_t zeros = 0, last = 0;
        bool inside = true, first_and_last = false;
        for (uint32_t side = 0; side < 4; side++) {
            int sign = at_side(planes, map, side);
            inside = inside && sign >= 0;
            if (sign == 0) {
                first_and_last = zeros == 1 && last == 0 && side == 3;
                zeros++;
                last = side;
            }
        }
        if (!inside)
            continue;
        site->map = (uint8_t)map;
        site->place = zeros == 0 ? PIR_CGM_INTERIOR : zeros == 1 ? PIR_CGM_EDGE : PIR_CGM_CORNER;
        site->cube_edge = arcs->cube_edge[map][last];
        // two sides meet in the corner that the later one starts from
        return zeros < 2 ? PIR_CGM_NONE : pir_cube_corner(map, pir_side_corner(first_and_last ? 0 : last));
    }
    PIR_ASSERT(false);
    return PIR_CGM_NONE;
}

static void sign_planes(struct pir_cgm_arcs *arcs, const struct pir_cgm_point *point,
                        int8_t ret_planes[PIR_CUBE_PLANES]) {
    for (uint32_t k = 0; k < PIR_CUBE_PLANES; k++)
        ret_planes[k] = (int8_t)pir_cgm_side(&arcs->sides, arcs->cgm, 2 * k, arcs->cgm, point);
}

static bool add_corners(struct pir_cgm_arcs *arcs) {
    for (uint32_t c = 0; c < 8; c++)
        if (add_site(arcs, (struct pir_site){.facet = PIR_CGM_NONE, .place = PIR_CGM_CORNER}) == PIR_CGM_NONE)
            return false;
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t side = 0; side < 4; side++) {
            // the sides before and after a corner, both with the square on the left, meet in its direction
            struct pir_site *site = &arcs->site[pir_cube_corner(map, pir_side_corner(side))];
            site->map = (uint8_t)map;
            site->point = pir_cgm_meet(arcs->cgm, pir_side_line(map, (side + 3) % 4), pir_side_line(map, side));
        }
    return true;
}

static bool add_facets(struct pir_cgm_arcs *arcs) {
    const pir_polytope *p = arcs->polytope;
    const pir_rotation *rotation = arcs->cgm->source[0].rotation;
    for (uint32_t f = 0; f < p->facet_count && !p->artificial; f++) {
        pir_vec3 n = rotation ? pir_mat_apply(&rotation->r, p->normal[f]) : p->normal[f];
        struct pir_site site = {.point = {f, PIR_CGM_NONE, n, rotation ? PIR_CGM_TURNED_ERROR : PIR_CGM_UNIT_ERROR},
                                .facet = f};
        sign_planes(arcs, &site.point, arcs->facet_planes[f]);
        uint32_t corner = locate(arcs, arcs->facet_planes[f], &site);
        arcs->facet_site[f] = corner != PIR_CGM_NONE ? corner : add_site(arcs, site);
        if (arcs->facet_site[f] == PIR_CGM_NONE)
            return false;
        arcs->site[arcs->facet_site[f]].facet = f;
    }
    return true;
}

/* --- walking one arc --- */

struct arc_walk {
    struct pir_cgm_arcs *arcs;
    uint32_t edge, line; /* the polytope's edge, its signed line */
    int corner[8];       /* on which side of the line the cube's corners are */
    uint32_t at, end;    /* sites: where it is, where it goes */
    const int8_t *end_planes;
};

static bool add_piece(struct arc_walk *walk, uint32_t to, uint32_t map, uint32_t cube_edge, bool forward) {
    struct pir_cgm_arcs *arcs = walk->arcs;
    void *block = arcs->piece;
    bool done =
        pir_cgm_grow(&arcs->allocator, &block, &arcs->piece_capacity, arcs->piece_count + 1, sizeof *arcs->piece);
    arcs->piece = block;
    if (done)
        arcs->piece[arcs->piece_count++] =
            (struct pir_arc_piece){walk->at, to, walk->edge, (uint8_t)map, (uint8_t)cube_edge, forward};
    walk->at = to;
    return done;
}

static int corner_sign(const struct arc_walk *walk, uint32_t map, uint32_t side) {
    return walk->corner[pir_cube_corner(map, pir_side_corner(side % 4))];
}

/* From inside map *map, or from its border inwards: to the end or out of it. *map is the next map to
   cross, or PIR_ALONG_EDGE. */
static bool cross_map(struct arc_walk *walk, uint32_t *map) {
    struct pir_cgm_arcs *arcs = walk->arcs;
    uint32_t side = 0;
    while (corner_sign(walk, *map, side) >= 0 || corner_sign(walk, *map, side + 1) < 0)
        side++;
    if (at_side(walk->end_planes, *map, side) >= 0)
        return add_piece(walk, walk->end, *map, 0, false);
    if (corner_sign(walk, *map, side + 1) == 0) {
        uint32_t corner = pir_cube_corner(*map, pir_side_corner((side + 1) % 4)), from = *map;
        *map = PIR_ALONG_EDGE;
        return add_piece(walk, corner, from, 0, false);
    }
    struct pir_site crossing = {.point = pir_cgm_meet(arcs->cgm, walk->line, pir_side_line(*map, side)),
                                .facet = PIR_CGM_NONE,
                                .place = PIR_CGM_EDGE,
                                .map = (uint8_t)*map,
                                .cube_edge = arcs->cube_edge[*map][side]};
    uint32_t site = add_site(arcs, crossing), from = *map;
    *map = pir_side_neighbor(*map, side);
    return site != PIR_CGM_NONE && add_piece(walk, site, from, 0, false);
}

/* Along cube edge `cube_edge`: to the end or to the corner ahead. */
static bool follow_edge(struct arc_walk *walk, uint32_t cube_edge, bool forward) {
    struct pir_cgm_arcs *arcs = walk->arcs;
    const struct pir_site *end = &arcs->site[walk->end];
    uint32_t map = arcs->edge_map[cube_edge], side = arcs->edge_side[cube_edge];
    uint32_t to = pir_cube_corner(map, pir_side_corner((side + forward) % 4));
    if (end->place == PIR_CGM_EDGE && end->cube_edge == cube_edge)
        to = walk->end;
    return add_piece(walk, to, PIR_ALONG_EDGE, cube_edge, forward);
}

/* From a point on a cube edge: the map it goes into, or PIR_ALONG_EDGE after following the edge. */
static bool start_on_edge(struct arc_walk *walk, uint32_t *ret_map) {
    struct pir_cgm_arcs *arcs = walk->arcs;
    uint32_t cube_edge = arcs->site[walk->at].cube_edge;
    uint32_t map = arcs->edge_map[cube_edge], side = arcs->edge_side[cube_edge];
    int sign = corner_sign(walk, map, side);
    *ret_map = sign > 0 ? map : sign < 0 ? pir_side_neighbor(map, side) : PIR_ALONG_EDGE;
    if (sign != 0)
        return true;
    return follow_edge(walk, cube_edge, pir_cgm_same_way(arcs->cgm, walk->line, arcs->cgm, pir_side_line(map, side)));
}

/* From a corner of the cube, in the same way. */
static bool start_at_corner(struct arc_walk *walk, uint32_t *ret_map) {
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t side = 0; side < 4; side++) {
            if (pir_cube_corner(map, pir_side_corner(side)) != walk->at)
                continue;
            // within the map, counter-clockwise: first this side, then the one before it
            int first = corner_sign(walk, map, side + 1), last = corner_sign(walk, map, side + 3);
            if (first > 0 || last <= 0)
                continue;
            *ret_map = first < 0 ? map : PIR_ALONG_EDGE;
            uint32_t cube_edge = walk->arcs->cube_edge[map][side];
            return first < 0 || follow_edge(walk, cube_edge, walk->arcs->edge_map[cube_edge] == map);
        }
    PIR_ASSERT(false);
    return false;
}

static bool walk_arc(struct arc_walk *walk) {
    struct pir_cgm_arcs *arcs = walk->arcs;
    // opposite corners have opposite signs
    for (uint32_t c = 0; c < 4; c++) {
        walk->corner[c] = pir_cgm_side(&arcs->sides, arcs->cgm, walk->line, arcs->cgm, &arcs->site[c].point);
        walk->corner[7 - c] = -walk->corner[c];
    }
    const struct pir_site *from = &arcs->site[walk->at];
    uint32_t map = from->place == PIR_CGM_INTERIOR ? from->map : PIR_ALONG_EDGE;
    bool done = true;
    // the first site differs from the last, and only the last step arrives there
    do {
        if (map != PIR_ALONG_EDGE)
            done = cross_map(walk, &map);
        else if (arcs->site[walk->at].place == PIR_CGM_EDGE)
            done = start_on_edge(walk, &map);
        else
            done = start_at_corner(walk, &map);
    } while (done && walk->at != walk->end);
    return done;
}

static bool walk_arcs(struct pir_cgm_arcs *arcs) {
    const pir_polytope *p = arcs->polytope;
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e], to = pir_right(p, h);
        arcs->piece_start[e] = arcs->piece_count;
        struct arc_walk walk = {.arcs = arcs,
                                .edge = e,
                                .line = 2 * (arcs->cgm->source[0].line_start + e),
                                .at = arcs->facet_site[p->left[h]],
                                .end = arcs->facet_site[to],
                                .end_planes = arcs->facet_planes[to]};
        if (!walk_arc(&walk))
            return false;
    }
    arcs->piece_start[p->edge_count] = arcs->piece_count;
    return true;
}

/* The great circle of a segment, from a point on a cube edge to its opposite and back. */
static bool walk_circle(struct pir_cgm_arcs *arcs) {
    uint32_t line = 2 * arcs->cgm->source[0].line_start, at[2] = {PIR_CGM_NONE, PIR_CGM_NONE};
    int8_t planes[2][PIR_CUBE_PLANES];
    // some cube plane meets the circle on a cube edge
    for (uint32_t k = 0; k < PIR_CUBE_PLANES && at[0] == PIR_CGM_NONE; k++) {
        bool any = false;
        for (uint32_t side = 0; side < 2; side++) {
            struct pir_site site = {.point = pir_cgm_meet(arcs->cgm, line, 2 * k + side), .facet = PIR_CGM_NONE};
            sign_planes(arcs, &site.point, planes[side]);
            for (uint32_t i = 0; i < PIR_CUBE_PLANES; i++)
                any = any || planes[side][i] != 0;
            // on all six planes is only the zero vector: the segment is along this plane's normal
            if (!any)
                break;
            uint32_t corner = locate(arcs, planes[side], &site);
            if (site.place == PIR_CGM_INTERIOR)
                break;
            at[side] = corner != PIR_CGM_NONE ? corner : add_site(arcs, site);
            if (at[side] == PIR_CGM_NONE)
                return false;
        }
    }
    PIR_ASSERT(at[0] != PIR_CGM_NONE && at[1] != PIR_CGM_NONE);
    for (uint32_t i = 0; i < 2; i++) {
        struct arc_walk walk = {
            .arcs = arcs, .edge = 0, .line = line, .at = at[i], .end = at[1 - i], .end_planes = planes[1 - i]};
        if (!walk_arc(&walk))
            return false;
    }
    arcs->piece_start[0] = 0;
    arcs->piece_start[1] = arcs->piece_start[2] = arcs->piece_count;
    return true;
}

/* --- all of it --- */

static void number_cube_edges(struct pir_cgm_arcs *arcs) {
    uint8_t count = 0;
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t side = 0; side < 4; side++) {
            uint32_t other = pir_side_neighbor(map, side);
            if (other > map) {
                arcs->edge_map[count] = (uint8_t)map;
                arcs->edge_side[count] = (uint8_t)side;
                arcs->cube_edge[map][side] = arcs->cube_edge[other][pir_side_beyond(map, side)] = count++;
            }
        }
}

bool pir_arcs_init(struct pir_cgm_arcs *arcs, const pir_cgm *cgm) {
    const pir_polytope *p = cgm->source[0].polytope;
    const pir_allocator *a = &cgm->allocator;
    *arcs = (struct pir_cgm_arcs){.allocator = *a, .cgm = cgm, .polytope = p};
    number_cube_edges(arcs);
    arcs->facet_site = PIR_NEW(a, uint32_t, p->facet_count);
    arcs->facet_planes = pir_memory_new(a, p->facet_count, sizeof *arcs->facet_planes);
    arcs->piece_start = PIR_ZEROED(a, uint32_t, (size_t)p->edge_count + 1);
    bool done = arcs->facet_site && arcs->facet_planes && arcs->piece_start &&
                pir_cgm_sides_init(&arcs->sides, a, cgm, cgm) && add_corners(arcs) && add_facets(arcs) &&
                (p->artificial ? walk_circle(arcs) : walk_arcs(arcs));
    if (!done)
        pir_arcs_finish(arcs);
    return done;
}

void pir_arcs_finish(struct pir_cgm_arcs *arcs) {
    const pir_allocator *a = &arcs->allocator;
    PIR_FREE(a, arcs->site, arcs->site_capacity);
    PIR_FREE(a, arcs->piece, arcs->piece_capacity);
    PIR_FREE(a, arcs->facet_site, arcs->polytope->facet_count);
    PIR_FREE(a, arcs->facet_planes, arcs->polytope->facet_count);
    PIR_FREE(a, arcs->piece_start, (size_t)arcs->polytope->edge_count + 1);
    pir_cgm_sides_finish(&arcs->sides, a);
}
