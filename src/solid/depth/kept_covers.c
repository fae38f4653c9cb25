/* SPDX-License-Identifier: MIT */
/*
 * See kept_covers.h. Facets are covered by doubles: a polygon whose nearest point is deeper than the margin in a sum is
 * cut by the planes of that sum, moved inwards by the margin. What is inside is covered, what is left in pieces is
 * covered in turn, or farther off than is asked for.
 *
 * Corners that cuts make are within 2^-50 of the sides that they cut, so all of a facet is within 2^-44 of the polygons
 * that it is cut into. That is taken from margins and from distances.
 */
#include "solid/depth/kept_covers.h"

#include <math.h>

#define ROUNDING 0x1p-42

/* Polygons with more corners, and facets in more polygons, are given up. */
#define MOST_CORNERS  32
#define MOST_POLYGONS 48

/* How many steps like the last a cover is to last: one after the other is tried. */
static const double lasting[] = {8, 2, 0};

/* A clock beyond this begins anew: an ulp of it is 2^-48. */
#define MOST_CLOCK 16

/* After a turn of this few covers hold, and few will. */
#define MOST_TURN 0x1p-4

/* A cover that lasts as many is as good as any. */
#define ENOUGH 2

/* How often what failed is tried again: at one of so many. */
#define RETRY 8

/* The cover of a facet that has none, but a level that has failed. */
#define EXPIRED 0x1p-1000

#define LEVELS (sizeof lasting / sizeof *lasting)

/* --- memory --- */

bool pir_kept_covers_init(pir_kept_covers *kept, pir_covers *covers) {
    const pir_obstacle *o = covers->obstacle;
    const pir_compound *p = o->frame.body[0].of;
    kept->covers = covers;
    kept->pair = PIR_ZEROED(&o->allocator, pir_kept_cover, o->pairs);
    kept->vertex = (double(*)[3])PIR_NEW(&o->allocator, double, 3 * (size_t)p->vertex_start[p->count]);
    return kept->pair && kept->vertex;
}

void pir_kept_covers_finish(pir_kept_covers *kept) {
    if (!kept->covers)
        return;
    const pir_obstacle *o = kept->covers->obstacle;
    PIR_FREE(&o->allocator, kept->pair, o->pairs);
    const pir_compound *p = o->frame.body[0].of;
    if (kept->vertex)
        PIR_FREE(&o->allocator, (double *)kept->vertex, 3 * (size_t)p->vertex_start[p->count]);
    PIR_FREE(&o->allocator, kept->facet, kept->facet_room);
}

/* --- the table --- */

pir_facet_key pir_facet_key_of(const pir_obstacle_plane *plane) {
    return (pir_facet_key){(uint64_t)plane->pair << 8 | (uint64_t)plane->kind, (uint64_t)plane->p << 32 | plane->q};
}

/* Where a key stands in the table or, where it does not, may be put: a place that is empty, or whose cover expired. */
static uint32_t place_of(const pir_kept_covers *kept, pir_facet_key key) {
    const uint64_t h = (key.features ^ key.pair_kind * 0x9e3779b97f4a7c15u) * 0xd6e8feb86659fd93u;
    uint32_t at = (uint32_t)(h >> 32) & (kept->facet_room - 1), expired = PIR_OBSTACLE_NONE;
    for (; kept->facet[at].cover.until > 0; at = (at + 1) & (kept->facet_room - 1)) {
        if (pir_facet_key_equal(kept->facet[at].key, key))
            return at;
        if (expired == PIR_OBSTACLE_NONE && kept->facet[at].cover.until <= kept->turned)
            expired = at;
    }
    return expired != PIR_OBSTACLE_NONE ? expired : at;
}

static void empty(pir_kept_covers *kept) {
    for (uint32_t i = 0; i < kept->facet_room; i++)
        kept->facet[i].cover.until = 0;
    kept->facet_count = 0;
}

/* Makes room in the table: doubles it, or, where most have expired, empties it. False when there is no memory. */
static bool grow(pir_kept_covers *kept) {
    const pir_allocator *a = &kept->covers->obstacle->allocator;
    const pir_kept_covers before = *kept;
    uint32_t live = 0;
    for (uint32_t i = 0; i < before.facet_room; i++)
        live += before.facet[i].cover.until > kept->turned;
    if (4 * live < before.facet_room) {
        empty(kept);
        return true;
    }
    const uint32_t room = before.facet_room ? 2 * before.facet_room : 256;
    pir_kept_facet *facet = room <= PIR_OBSTACLE_MOST ? PIR_ZEROED(a, pir_kept_facet, room) : NULL;
    if (!facet)
        return false;
    kept->facet = facet;
    kept->facet_room = room;
    kept->facet_count = 0;
    for (uint32_t i = 0; i < before.facet_room; i++)
        if (before.facet[i].cover.until > kept->turned) {
            kept->facet[place_of(kept, before.facet[i].key)] = before.facet[i];
            kept->facet_count++;
        }
    PIR_FREE(a, before.facet, before.facet_room);
    return true;
}

/* Keeps a cover, or not, where there is no memory: then it is made again. */
static void keep(pir_kept_covers *kept, const pir_kept_facet *facet) {
    if (2 * kept->facet_count >= kept->facet_room && !grow(kept))
        return;
    pir_kept_facet *to = &kept->facet[place_of(kept, facet->key)];
    kept->facet_count += !(to->cover.until > 0);
    *to = *facet;
}

/* --- the clock --- */

static double square_between(const double a[3], const double b[3]) {
    const double to[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
}

static void forget(pir_kept_covers *kept) {
    for (uint32_t i = 0; i < kept->covers->obstacle->pairs; i++)
        kept->pair[i].until = 0;
    empty(kept);
    kept->turned = kept->way = 0;
}

/* By which part of its length a vector of P has changed at most: the norm of the difference of two rotations, which has
 * one singular value twice, and 0. */
static double turn_since(const pir_kept_covers *kept, const pir_mat3 *r) {
    double square = 0;
    for (int k = 0; k < 9; k++)
        square += (r->m[k / 3][k % 3] - kept->rotation[k]) * (r->m[k / 3][k % 3] - kept->rotation[k]);
    return sqrt(square / 2) * (1 + 0x1p-40) + 0x1p-46;
}

bool pir_kept_covers_step(pir_kept_covers *kept) {
    const pir_obstacle *o = kept->covers->obstacle;
    const pir_framed_body *p = &o->frame.body[0];
    const uint32_t vertices = p->of->vertex_start[p->of->count];
    double square = 0;
    for (uint32_t v = 0; v < vertices; v++) {
        double at[3];
        for (int k = 0; k < 3; k++)
            at[k] = p->vertex[v][k] - o->frame.t[k];
        if (kept->begun)
            square = fmax(square, square_between(kept->vertex[v], at));
        for (int k = 0; k < 3; k++)
            kept->vertex[v][k] = at[k];
    }
    // displacements are affine in the point, so no point of A' has a longer one than its vertices
    kept->step_way = sqrt(square) * (1 + 0x1p-48) + 0x1p-45;
    kept->step_turned = kept->begun ? turn_since(kept, &o->frame.rotation.r) : 0;
    for (int k = 0; k < 9; k++)
        kept->rotation[k] = o->frame.rotation.r.m[k / 3][k % 3];
    kept->turned += kept->step_turned;
    kept->way += kept->step_way;
    if (!kept->begun || kept->way > MOST_CLOCK || kept->turned > MOST_CLOCK)
        forget(kept);
    const bool pays = kept->begun && kept->step_turned < MOST_TURN;
    kept->begun = true;
    return pays;
}

double pir_kept_covers_more(const pir_kept_covers *kept) {
    return lasting[0] * kept->step_way;
}

/* --- distances --- */

/* The point of a polygon that is nearest to t, by doubles; on its plane, of normal n, or on a side. */
static double nearest_of(const double n[3], uint32_t count, double (*corner)[3], const double t[3], double ret[3]) {
    double square = HUGE_VAL;
    bool left = false, right = false;
    for (uint32_t i = 0; i < count; i++) {
        const double *a = corner[i], *b = corner[i + 1 < count ? i + 1 : 0];
        const double e[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]}, w[3] = {t[0] - a[0], t[1] - a[1], t[2] - a[2]};
        const double side = n[0] * (e[1] * w[2] - e[2] * w[1]) + n[1] * (e[2] * w[0] - e[0] * w[2]) +
                            n[2] * (e[0] * w[1] - e[1] * w[0]);
        const double length = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
        const double part = length > 0 ? (e[0] * w[0] + e[1] * w[1] + e[2] * w[2]) / length : 0;
        const double by = part > 0 ? (part < 1 ? part : 1) : 0;
        const double foot[3] = {a[0] + by * e[0], a[1] + by * e[1], a[2] + by * e[2]};
        const double s = square_between(foot, t);
        if (s < square) {
            square = s;
            for (int k = 0; k < 3; k++)
                ret[k] = foot[k];
        }
        left = left || side > 0;
        right = right || side < 0;
    }
    if (left && right)
        return sqrt(square);
    const double *a = corner[0];
    const double above = n[0] * (t[0] - a[0]) + n[1] * (t[1] - a[1]) + n[2] * (t[2] - a[2]);
    for (int k = 0; k < 3; k++)
        ret[k] = t[k] - above * n[k];
    return fabs(above);
}

double pir_facet_distance(const pir_obstacle *o, uint32_t plane, uint32_t count, double (*corner)[3], double least) {
    double at[3];
    return count > 0 ? fmax(least, nearest_of(o->plane[plane].n, count, corner, o->point[0].x, at) - ROUNDING) : least;
}

/* --- covering --- */

struct covering {
    pir_covers *covers;
    double n[3], t[3];
    double reach; /* what is nearer is to be covered */
    pir_cover_need need;
    uint32_t first;    /* the pair that covers the nearest point of the facet */
    uint32_t polygons; /* that have been looked at */
};

struct polygon {
    uint32_t count;
    double at[MOST_CORNERS][3];
};

static void add_corner(struct polygon *to, const double x[3]) {
    if (to->count < MOST_CORNERS)
        for (int k = 0; k < 3; k++)
            to->at[to->count][k] = x[k];
    to->count++; // above MOST_CORNERS: given up
}

/* Divides a polygon by how far its corners are above a plane: what is above it, what is below. */
static void divide(const struct polygon *of, const double height[MOST_CORNERS], struct polygon *above,
                   struct polygon *below) {
    above->count = below->count = 0;
    for (uint32_t i = 0; i < of->count; i++) {
        const uint32_t j = i + 1 < of->count ? i + 1 : 0;
        const double a = height[i], b = height[j];
        if (a >= 0)
            add_corner(above, of->at[i]);
        if (a <= 0)
            add_corner(below, of->at[i]);
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            const double by = a / (a - b);
            double x[3];
            for (int k = 0; k < 3; k++)
                x[k] = of->at[i][k] + by * (of->at[j][k] - of->at[i][k]);
            add_corner(above, x);
            add_corner(below, x);
        }
    }
}

/* Whether all of a polygon that is nearer than the reach is inside of sums by the margin. */
static bool is_covered(struct covering *c, struct polygon *of) {
    pir_obstacle *o = c->covers->obstacle;
    double x[3];
    if (of->count < 3 || nearest_of(c->n, of->count, of->at, c->t, x) - ROUNDING > c->reach)
        return true;
    if (of->count > MOST_CORNERS || ++c->polygons > MOST_POLYGONS)
        return false;
    const uint32_t cover = pir_covers_about(c->covers, &c->need, c->polygons == 1 ? c->first : PIR_OBSTACLE_NONE, x);
    if (cover == PIR_OBSTACLE_NONE || o->status != PIR_OK)
        return false;
    c->first = c->polygons == 1 ? cover : c->first;
    const pir_obstacle_sum sum = o->sum[cover];
    const double margin = pir_covers_margin(c->covers, &c->need, cover) - ROUNDING;
    struct polygon rest = *of, above, below;
    for (uint32_t f = sum.first; f < sum.first + sum.count; f++) {
        const pir_obstacle_plane *plane = &o->plane[f];
        const double most = plane->d - plane->err - margin;
        double height[MOST_CORNERS];
        bool crosses = false;
        for (uint32_t i = 0; i < rest.count; i++) {
            height[i] = plane->n[0] * rest.at[i][0] + plane->n[1] * rest.at[i][1] + plane->n[2] * rest.at[i][2] - most;
            crosses = crosses || height[i] > 0;
        }
        if (!crosses)
            continue;
        divide(&rest, height, &above, &below);
        if (above.count > MOST_CORNERS || below.count > MOST_CORNERS || !is_covered(c, &above))
            return false;
        rest = below;
        if (rest.count < 3)
            return true;
    }
    return true;
}

/* Finds a cover of the facet of a plane by doubles, and notes it and who covers it. */
static void cover_facet(pir_kept_covers *kept, uint32_t plane, uint32_t count, double (*corner)[3], double most,
                        pir_kept_facet *facet) {
    const pir_obstacle *o = kept->covers->obstacle;
    const uint32_t own = o->plane[plane].pair;
    const double turn = pir_covers_all(kept->covers, own, ENOUGH * kept->step_turned, &facet->cover_pair, count,
                                       (const double(*)[3])corner);
    facet->cover = (pir_kept_cover){kept->turned + turn, HUGE_VAL};
    if (turn > 0) {
        facet->level = 0;
        return;
    }
    struct covering c = {.covers = kept->covers, .first = facet->cover_pair};
    for (int k = 0; k < 3; k++) {
        c.n[k] = o->plane[plane].n[k];
        c.t[k] = o->point[0].x[k];
    }
    // a level that failed is tried again at times
    const uint32_t first = facet->level > 0 && ++kept->makes % RETRY == 0 ? facet->level - 1 : facet->level;
    for (uint32_t i = first; i < LEVELS; i++) {
        struct polygon whole = {.count = count};
        for (uint32_t k = 0; k < count; k++)
            for (int j = 0; j < 3; j++)
                whole.at[k][j] = corner[k][j];
        c.reach = most + lasting[i] * kept->step_way;
        c.need = (pir_cover_need){own, 3 * ROUNDING, lasting[i] * kept->step_turned};
        c.polygons = 0;
        if (is_covered(&c, &whole)) {
            facet->cover = (pir_kept_cover){kept->turned + c.need.turn + 0x1p-60, kept->way + c.reach};
            facet->cover_pair = c.first;
            facet->level = i;
            return;
        }
    }
    facet->cover = (pir_kept_cover){EXPIRED, 0};
    facet->level = LEVELS;
}

/* The entry of a facet, if it has one. */
static const pir_kept_facet *find(const pir_kept_covers *kept, pir_facet_key key) {
    const pir_kept_facet *known = kept->facet_room > 0 ? &kept->facet[place_of(kept, key)] : NULL;
    return known && known->cover.until > 0 && pir_facet_key_equal(known->key, key) ? known : NULL;
}

pir_kept_cover pir_kept_covers_find(const pir_kept_covers *kept, uint32_t plane, double most) {
    const pir_kept_facet *known = find(kept, pir_facet_key_of(&kept->covers->obstacle->plane[plane]));
    return known && pir_kept_cover_holds(kept, known->cover, most) ? known->cover : (pir_kept_cover){0, 0};
}

pir_kept_cover pir_kept_covers_make(pir_kept_covers *kept, uint32_t plane, uint32_t count, double (*corner)[3],
                                    double most) {
    const pir_facet_key key = pir_facet_key_of(&kept->covers->obstacle->plane[plane]);
    const pir_kept_facet *known = find(kept, key);
    pir_kept_facet facet = known ? *known : (pir_kept_facet){.key = key, .cover_pair = PIR_OBSTACLE_NONE};
    cover_facet(kept, plane, count, corner, most, &facet);
    if (kept->covers->obstacle->status == PIR_OK)
        keep(kept, &facet);
    return facet.level < LEVELS ? facet.cover : (pir_kept_cover){0, 0};
}
