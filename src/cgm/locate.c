/* SPDX-License-Identifier: MIT */
/*
 * Where a point is (Fogel and Halperin, section 4).
 *
 * With c strictly inside and s the point asked about, the ray from c through s stabs the facet with the greatest a/b,
 * where for a normal n and a point x of its facet a = n·(s − c) and b = n·(x − c) > 0. That is a linear function
 * on the polar polytope about c, the vertices and edges of which are the real vertices and real edges of the map: a
 * walk that goes on as long as a neighbour is strictly better ends at the greatest. Then s is outside, on the boundary
 * or inside as n·(s − x) is positive, zero or negative.
 *
 * Without such a c every vertex of the maps is checked, the artificial ones too. A body, even a flat one, is what lies
 * below its support planes in all those directions: the ends of arcs on cube edges and the corners of the cube bound
 * the directions in which a flat body has no facets.
 *
 * Doubles with a bound decide signs, or else integers; a coordinate of the point is an integer times a power of two.
 */
#include "cgm/build.h"
#include "cgm/place.h"
#include "cgm/sides.h"

#define U 0x1p-53

struct pir_cgm_locator {
    pir_cgm *cgm; /* a reference */
    struct pir_cgm_places places;
    bool solid; /* whether `centre` is strictly inside */
    pir_vec3 centre;
    double size; /* no vertex of the body is farther from the origin */
    pir_limbs scratch;
};

/* A point, and a bound on its distance from the origin. */
struct located_point {
    pir_vec3 at;
    double length;
};

/* A face beside vertex v that is not the outer one: it carries an extreme vertex in v's direction. */
static uint32_t face_at(const pir_cgm *cgm, uint32_t v) {
    return cgm->half[cgm->vertex[v].out].face;
}

/* Limbs of a coordinate in units of 2^-1074 or coarser. */
#define POINT_LIMBS (2100 / GMP_NUMB_BITS + 2)

/* The lowest bit that any of the coordinates may have set, at most 0: they are integers in units of it. */
static int unit_exponent(pir_vec3 a, pir_vec3 b) {
    const double c[6] = {a.x, a.y, a.z, b.x, b.y, b.z};
    int low = 0;
    for (int k = 0; k < 6; k++) {
        int e = 0;
        frexp(c[k], &e);
        low = e - 53 < low && c[k] != 0 ? e - 53 : low;
    }
    return low < -1074 ? -1074 : low;
}

static pir_int3 exact_point(pir_vec3 v, int low, pir_limbs *scratch) {
    pir_int3 p = pir_int3_take(scratch, POINT_LIMBS);
    pir_int_set_double(&p.c[0], v.x, low);
    pir_int_set_double(&p.c[1], v.y, low);
    pir_int_set_double(&p.c[2], v.z, low);
    return p;
}

/*
 * n·(x − p), for the normal n of v and a point x of its facet, times the positive 2^-low · D of places; in scratch.
 */
static pir_int exact_height(struct pir_cgm_locator *l, uint32_t v, const pir_int3 *p, int low) {
    pir_limbs *scratch = &l->scratch;
    uint32_t limbs = l->places.stride + POINT_LIMBS + pir_int_length(&l->places.scale.den) + 2;
    pir_int height = pir_limbs_take(scratch, limbs + pir_cgm_point_limbs(l->cgm) + 2);
    uint32_t mark = scratch->used;
    pir_int3 x = pir_int3_take(scratch, l->places.stride), d = pir_int3_take(scratch, limbs);
    pir_cgm_place_exact(&l->places, face_at(l->cgm, v), &x);
    for (int k = 0; k < 3; k++) {
        pir_int_shift_left(&d.c[k], &x.c[k], (uint32_t)-low);
        pir_int_sub_mul(&d.c[k], &p->c[k], &l->places.scale.den, scratch);
    }
    pir_int3 n = pir_cgm_point_exact(l->cgm, &l->cgm->vertex[v].point, scratch);
    pir_int3_dot(&height, &n, &d, scratch);
    scratch->used = mark;
    return height;
}

/* By doubles: n·(x − p) for the unit normal, and a bound on its error. */
static double near_height(const struct pir_cgm_locator *l, uint32_t v, const struct located_point *p,
                          double *ret_error) {
    const struct pir_cgm_point *n = &l->cgm->vertex[v].point;
    pir_vec3 x = pir_cgm_place_near(l->cgm, face_at(l->cgm, v));
    *ret_error = (n->error + 16 * U) * (p->length + l->size) + (64 + l->cgm->source_count) * U * l->size;
    return pir_vec_dot(n->unit, pir_vec_sub(x, p->at));
}

/* The sign of n·(x − p): 1 when p is below the plane of v. */
static int height_sign(struct pir_cgm_locator *l, uint32_t v, const struct located_point *p) {
    double error, height = near_height(l, v, p, &error);
    error += 0x1p-1000;
    if (height > error || height < -error)
        return height > 0 ? 1 : -1;
    pir_limbs *scratch = &l->scratch;
    uint32_t mark = scratch->used;
    int low = unit_exponent(p->at, p->at);
    pir_int3 exact = exact_point(p->at, low, scratch);
    pir_int value = exact_height(l, v, &exact, low);
    scratch->used = mark;
    return pir_int_sign(&value);
}

/* --- the walk --- */

/* a_v b_w − a_w b_v exactly, its sign. */
static int exact_order(struct pir_cgm_locator *l, const struct located_point *s, uint32_t v, uint32_t w) {
    pir_limbs *scratch = &l->scratch;
    uint32_t mark = scratch->used;
    int low = unit_exponent(s->at, l->centre);
    pir_int3 to = exact_point(s->at, low, scratch), from = exact_point(l->centre, low, scratch);
    pir_int3 way = pir_int3_take(scratch, POINT_LIMBS + 1);
    for (int k = 0; k < 3; k++)
        pir_int_sub(&way.c[k], &to.c[k], &from.c[k]);
    uint32_t at[2] = {v, w}, limbs = POINT_LIMBS + pir_cgm_point_limbs(l->cgm) + 4;
    pir_int a[2], b[2];
    for (int i = 0; i < 2; i++) {
        a[i] = pir_limbs_take(scratch, limbs);
        uint32_t inner = scratch->used;
        pir_int3 n = pir_cgm_point_exact(l->cgm, &l->cgm->vertex[at[i]].point, scratch);
        pir_int3_dot(&a[i], &n, &way, scratch);
        scratch->used = inner;
        b[i] = exact_height(l, at[i], &from, low);
    }
    pir_int order = pir_limbs_take(scratch, limbs + pir_int_length(&b[0]) + pir_int_length(&b[1]) + 2);
    pir_int_mul(&order, &a[0], &b[1]);
    pir_int_sub_mul(&order, &a[1], &b[0], scratch);
    scratch->used = mark;
    return pir_int_sign(&order);
}

/* Whether the plane of w is cut by the ray strictly before that of v: a_w b_v > a_v b_w. */
static bool is_better(struct pir_cgm_locator *l, const struct located_point *s, uint32_t w, uint32_t v) {
    struct located_point c = {l->centre, pir_vec_taxicab(l->centre)};
    uint32_t at[2] = {w, v};
    double a[2], b[2], a_error[2], b_error[2];
    for (int i = 0; i < 2; i++) {
        const struct pir_cgm_point *n = &l->cgm->vertex[at[i]].point;
        a[i] = pir_vec_dot(n->unit, pir_vec_sub(s->at, c.at));
        a_error[i] = (n->error + 16 * U) * (s->length + c.length);
        b[i] = near_height(l, at[i], &c, &b_error[i]);
    }
    double order = a[0] * b[1] - a[1] * b[0], bound = 0x1p-1000;
    for (int i = 0; i < 2; i++)
        bound +=
            (fabs(a[i]) + a_error[i]) * b_error[1 - i] + fabs(b[1 - i]) * a_error[i] + 4 * U * fabs(a[i] * b[1 - i]);
    if (order > bound || order < -bound)
        return order > 0;
    return exact_order(l, s, w, v) > 0;
}

/*
 * The real vertex at the other end of the arc that real halfedge h begins, past the places where it crosses cube edges.
 */
static uint32_t follow_arc(const pir_cgm *cgm, uint32_t h) {
    uint32_t v = pir_cgm_target(cgm, h), cell = cgm->half[h].face;
    while (!cgm->vertex[v].real) {
        // it goes on with the same cell on its left
        struct pir_cgm_around around = pir_cgm_around_new(cgm, v);
        while (!pir_cgm_edge_is_real(cgm, around.half >> 1) ||
               !pir_cgm_same_cell(cgm, cgm->half[around.half].face, cell)) {
            bool more = pir_cgm_around_next(cgm, &around);
            PIR_ASSERT(more);
            (void)more;
        }
        v = pir_cgm_target(cgm, around.half);
    }
    return v;
}

/* A neighbour that is strictly better, or v. */
static uint32_t step(struct pir_cgm_locator *l, const struct located_point *s, uint32_t v) {
    struct pir_cgm_around around = pir_cgm_around_new(l->cgm, v);
    do {
        if (!pir_cgm_edge_is_real(l->cgm, around.half >> 1))
            continue;
        uint32_t w = follow_arc(l->cgm, around.half);
        if (is_better(l, s, w, v))
            return w;
    } while (pir_cgm_around_next(l->cgm, &around));
    return v;
}

/* Any real vertex, one in the map that the direction from the centre points to if there is one. */
static uint32_t first_vertex(const struct pir_cgm_locator *l, pir_vec3 point) {
    const pir_cgm *cgm = l->cgm;
    pir_vec3 d = pir_vec_sub(point, l->centre);
    double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    uint32_t map = x >= y && x >= z ? (d.x < 0 ? 0 : 3) : y >= z ? (d.y < 0 ? 1 : 4) : (d.z < 0 ? 2 : 5);
    uint32_t count = pir_cgm_vertices(cgm), v = cgm->vertex_start[map];
    while (!cgm->vertex[v].real)
        v = v + 1 == count ? 0 : v + 1;
    return v;
}

/* --- all vertices --- */

static void look_at_all(struct pir_cgm_locator *l, const struct located_point *s, pir_cgm_location *location) {
    *location = (pir_cgm_location){PIR_CGM_INSIDE, 0, 0};
    for (uint32_t v = 0; v < pir_cgm_vertices(l->cgm) && location->position != PIR_CGM_OUTSIDE;
         v++, location->steps++) {
        int sign = height_sign(l, v, s);
        if (sign > 0 || (sign == 0 && location->position == PIR_CGM_BOUNDARY))
            continue;
        location->position = sign < 0 ? PIR_CGM_OUTSIDE : PIR_CGM_BOUNDARY;
        location->witness = v;
    }
}

pir_status pir_cgm_locate(pir_cgm_locator *l, pir_vec3 point, uint32_t witness, pir_cgm_location *ret_location) {
    if (!l || !ret_location || (witness != PIR_CGM_NONE && witness >= pir_cgm_vertices(l->cgm)))
        return PIR_ERR_ARGUMENT;
    if (!pir_vec_is_finite(point))
        return PIR_ERR_NOT_FINITE;
    struct located_point s = {point, pir_vec_taxicab(point)};
    if (!l->solid) {
        look_at_all(l, &s, ret_location);
        return PIR_OK;
    }
    uint32_t v = witness != PIR_CGM_NONE && l->cgm->vertex[witness].real ? witness : first_vertex(l, point), steps = 0;
    for (uint32_t next; (next = step(l, &s, v)) != v; v = next)
        steps++;
    int sign = height_sign(l, v, &s);
    *ret_location = (pir_cgm_location){sign > 0    ? PIR_CGM_INSIDE
                                       : sign == 0 ? PIR_CGM_BOUNDARY
                                                   : PIR_CGM_OUTSIDE,
                                       v, steps};
    return PIR_OK;
}

/* --- making one --- */

/* Puts the centre where the cells' vertices are on average; whether that is strictly inside. */
static bool find_centre(struct pir_cgm_locator *l) {
    const pir_cgm *cgm = l->cgm;
    pir_vec3 sum = {0, 0, 0};
    uint32_t faces = pir_cgm_faces(cgm) - 6;
    for (uint32_t map = 0; map < 6; map++)
        for (uint32_t f = cgm->face_start[map] + 1; f < cgm->face_start[map + 1]; f++)
            sum = pir_vec_add(sum, pir_vec_scale(pir_cgm_place_near(cgm, f), 1.0 / faces));
    l->centre = sum;
    if (!pir_vec_is_finite(sum))
        return false;
    struct located_point c = {sum, pir_vec_taxicab(sum)};
    bool any = false;
    for (uint32_t v = 0; v < pir_cgm_vertices(cgm); v++) {
        if (cgm->vertex[v].real && height_sign(l, v, &c) <= 0)
            return false;
        any = any || cgm->vertex[v].real;
    }
    return any;
}

pir_status pir_cgm_locator_create(const pir_cgm *cgm, pir_cgm_locator **ret_locator) {
    if (!cgm || !ret_locator)
        return PIR_ERR_ARGUMENT;
    const pir_allocator *a = &cgm->allocator;
    pir_cgm_locator *l = PIR_ZEROED(a, pir_cgm_locator, 1);
    if (!l)
        return PIR_ERR_MEMORY;
    if (!pir_cgm_places_init(&l->places, cgm)) {
        PIR_FREE(a, l, 1);
        return PIR_ERR_MEMORY;
    }
    /*
     * exact_order takes most: three points (9 (POINT_LIMBS + 1)); two products a and two heights b, none longer than
     * `height`; while the second is made, its point x and difference d of three components each and one product; and a
     * direction of three components (3 point) with the two lines it is made from (6 line) and one product. So 11
     * heights, 3 directions and 7 lines at a time; the last product, of two heights, comes when x and d are gone.
     */
    uint32_t point = pir_cgm_point_limbs(cgm),
             height = l->places.stride + POINT_LIMBS + point + l->places.limb_count + 8;
    uint32_t capacity = 10 * (POINT_LIMBS + 1) + 12 * height + 12 * point + 16 * cgm->line_limbs;
    l->scratch = (pir_limbs){PIR_NEW(a, mp_limb_t, capacity), 0, capacity};
    if (!l->scratch.base) {
        pir_cgm_places_finish(&l->places);
        PIR_FREE(a, l, 1);
        return PIR_ERR_MEMORY;
    }
    l->cgm = pir_cgm_retain(cgm);
    for (uint32_t s = 0; s < cgm->source_count; s++) {
        const pir_polytope *p = cgm->source[s].polytope;
        double most = 0;
        for (uint32_t v = 0; v < p->vertex_count; v++)
            most = fmax(most, pir_vec_taxicab(p->vertex[v]));
        l->size += most * (1 + 8 * U);
    }
    l->solid = find_centre(l);
    *ret_locator = l;
    return PIR_OK;
}

void pir_cgm_locator_destroy(pir_cgm_locator *l) {
    if (!l)
        return;
    const pir_allocator allocator = l->cgm->allocator;
    PIR_FREE(&allocator, l->scratch.base, l->scratch.capacity);
    pir_cgm_places_finish(&l->places);
    pir_cgm_release(l->cgm);
    PIR_FREE(&allocator, l, 1);
}
