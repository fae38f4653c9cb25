/* SPDX-License-Identifier: MIT */
/*
 * A segment against a rounded polytope, in doubles. Its surface is made of facets moved outwards by the radius, of
 * parts of cylinders about edges and of parts of balls about vertices. Where a line crosses one of these it is on the
 * rounded body; and that is convex. So the line is in it from the first such place to the last.
 */
#include "scene/query/ray_rounded.h"

/*
 * Places beyond the rim of a facet or the end of an edge by this part of the size count too: next to a rim the surface
 * bends away by the square of it only, and none is lost between two parts.
 */
#define RIM 0x1p-34

/* The line at hand: base + s·u, with the base near the body. */
struct rounded_line {
    const pir_polytope *p;
    double radius, rim;
    pir_vec3 base, u;
    double first, last; /* where it is on the rounded body; first > last: nowhere so far */
    pir_vec3 normal;    /* at the first */
};

static double length(pir_vec3 v) {
    return sqrt(pir_vec_dot(v, v));
}

static pir_vec3 at(const struct rounded_line *line, double s) {
    return pir_vec_add(line->base, pir_vec_scale(line->u, s));
}

static void note(struct rounded_line *line, double s, pir_vec3 normal) {
    if (s < line->first) {
        line->first = s;
        line->normal = normal;
    }
    line->last = fmax(line->last, s);
}

/* Whether a point is over a facet: within all walls along its sides. */
static bool is_over(const pir_polytope *p, uint32_t f, pir_vec3 x, double rim) {
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++) {
        uint32_t half = p->loop[i];
        if (pir_vec_dot(pir_wall_normal(p, f, half), pir_vec_sub(x, p->vertex[p->origin[half]])) > rim)
            return false;
    }
    return true;
}

static void cross_facet(struct rounded_line *line, uint32_t f) {
    const pir_polytope *p = line->p;
    double rate = pir_vec_dot(p->normal[f], line->u);
    double s = (pir_facet_slack(p, f, line->base) + line->radius) / rate;
    if (fabs(rate) > 0x1p-60 && is_over(p, f, at(line, s), line->rim))
        note(line, s, p->normal[f]);
}

/* The places s where |w + s·v| is the radius, from the nearest to 0 in `within` on. False where there are none. */
static bool circle(pir_vec3 w, pir_vec3 v, double radius, const double within[2], double ret_s[2]) {
    double a = pir_vec_dot(v, v);
    if (!(a > 0x1p-100))
        return false;
    double from = fmin(fmax(-pir_vec_dot(w, v) / a, within[0]), within[1]);
    pir_vec3 near = pir_vec_add(w, pir_vec_scale(v, from));
    double b = pir_vec_dot(near, v), off = length(near), c = (off - radius) * (off + radius), square = b * b - a * c;
    if (square < 0)
        return false;
    double q = -(b + (b < 0 ? -sqrt(square) : sqrt(square))), x = q / a, y = q != 0 ? c / q : x;
    ret_s[0] = from + fmin(x, y);
    ret_s[1] = from + fmax(x, y);
    return true;
}

static void cross_vertex(struct rounded_line *line, uint32_t v) {
    const double anywhere[2] = {-HUGE_VAL, HUGE_VAL};
    double s[2];
    pir_vec3 w = pir_vec_sub(line->base, line->p->vertex[v]);
    for (int k = 0; k < 2 && circle(w, line->u, line->radius, anywhere, s); k++)
        note(line, s[k], pir_vec_scale(pir_vec_add(w, pir_vec_scale(line->u, s[k])), 1 / line->radius));
}

static void cross_edge(struct rounded_line *line, uint32_t edge) {
    const pir_polytope *p = line->p;
    const uint32_t half = p->edge_half[edge];
    const pir_vec3 from = p->vertex[p->origin[half]], e = p->direction[half], w = pir_vec_sub(line->base, from);
    const double long_is = pir_vec_dot(e, pir_vec_sub(p->vertex[p->target[half]], from));
    const double along = pir_vec_dot(w, e), rate = pir_vec_dot(line->u, e);
    const pir_vec3 off = pir_vec_sub(w, pir_vec_scale(e, along)), across = pir_vec_sub(line->u, pir_vec_scale(e, rate));
    double within[2] = {-HUGE_VAL, HUGE_VAL}, s[2];
    if (fabs(rate) > 0.5) {
        within[0] = fmin(-along / rate, (long_is - along) / rate);
        within[1] = fmax(-along / rate, (long_is - along) / rate);
    }
    for (int k = 0; k < 2 && circle(off, across, line->radius, within, s); k++) {
        double at_edge = along + s[k] * rate;
        if (at_edge >= -line->rim && at_edge <= long_is + line->rim)
            note(line, s[k], pir_vec_scale(pir_vec_add(off, pir_vec_scale(across, s[k])), 1 / line->radius));
    }
}

static void cross_all(struct rounded_line *line) {
    const pir_polytope *p = line->p;
    for (uint32_t f = 0; f < p->facet_count && p->dimension >= 2; f++)
        cross_facet(line, f);
    for (uint32_t e = 0; e < p->edge_count && (p->dimension >= 2 || e == 0); e++)
        cross_edge(line, e);
    for (uint32_t v = 0; v < p->vertex_count; v++)
        cross_vertex(line, v);
}

/* --- a point in the rounded body --- */

static void take_nearer(pir_vec3 *best, pir_vec3 off) {
    if (pir_vec_dot(off, off) < pir_vec_dot(*best, *best))
        *best = off;
}

/* From the polytope's point nearest to x, to x: of facets that x is over, of edges, of vertices. */
static pir_vec3 off_polytope(const pir_polytope *p, pir_vec3 x) {
    pir_vec3 best = pir_vec_sub(x, p->vertex[0]);
    for (uint32_t v = 1; v < p->vertex_count; v++)
        take_nearer(&best, pir_vec_sub(x, p->vertex[v]));
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t half = p->edge_half[e];
        pir_vec3 from = p->vertex[p->origin[half]], side = pir_vec_sub(p->vertex[p->target[half]], from);
        double part = pir_vec_dot(pir_vec_sub(x, from), side) / pir_vec_dot(side, side);
        if (part > 0 && part < 1)
            take_nearer(&best, pir_vec_sub(x, pir_vec_add(from, pir_vec_scale(side, part))));
    }
    for (uint32_t f = 0; f < p->facet_count && p->dimension >= 2; f++) {
        double height = -pir_facet_slack(p, f, x);
        if (height > 0 && is_over(p, f, x, 0))
            take_nearer(&best, pir_vec_scale(p->normal[f], height));
    }
    return best;
}

/* Of the unit vectors across a segment, the one nearest to `against`. */
static pir_vec3 across_segment(pir_vec3 e, pir_vec3 against) {
    pir_vec3 across = pir_vec_sub(against, pir_vec_scale(e, pir_vec_dot(e, against)));
    if (pir_vec_dot(across, across) < 0x1p-40)
        across = pir_vec_cross(e, fabs(e.x) < 0.5 ? (pir_vec3){1, 0, 0} : (pir_vec3){0, 1, 0});
    return pir_vec_scale(across, 1 / length(across));
}

/* The unit normal by which a point of the rounded body leaves it soonest; in a ball's middle `against`. */
static pir_vec3 normal_of_depth(const pir_polytope *p, pir_vec3 x, pir_vec3 against) {
    uint32_t least = p->dimension >= 2 ? pir_least_facet(p, x) : 0;
    if (p->dimension == 3 && pir_facet_slack(p, least, x) >= 0)
        return p->normal[least];
    pir_vec3 off = off_polytope(p, x);
    if (pir_vec_dot(off, off) > 0)
        return pir_vec_scale(pir_against(off), -1);
    return p->dimension == 2 ? p->normal[0] : p->dimension == 1 ? across_segment(p->direction[0], against) : against;
}

/* A point within the radius of the polytope. */
static pir_entry hold(const pir_polytope *p, pir_vec3 x, double radius) {
    const bool within = p->dimension == 3 && pir_facet_slack(p, pir_least_facet(p, x), x) >= 0;
    const double off = within ? 0 : length(off_polytope(p, x));
    const pir_vec3 normal = normal_of_depth(p, x, (pir_vec3){0, 0, 0});
    return (pir_entry){off <= radius, off < radius, off <= radius ? 0 : 1, normal, 0};
}

pir_entry pir_ray_rounded(const pir_polytope *p, const pir_ray_segment *segment, double radius) {
    const pir_vec3 against = pir_against(segment->way), u = {-against.x, -against.y, -against.z};
    const double way = pir_vec_dot(u, segment->way);
    if (!(way > 0))
        return hold(p, segment->from, radius);
    const pir_vec3 middle = p->vertex[0];
    const double to_base = pir_vec_dot(u, pir_vec_sub(middle, segment->from));
    struct rounded_line line = {.p = p, .radius = radius, .u = u, .first = HUGE_VAL, .last = -HUGE_VAL};
    line.base = pir_vec_add(segment->from, pir_vec_scale(u, to_base));
    for (uint32_t v = 0; v < p->vertex_count; v++)
        line.rim = fmax(line.rim, length(pir_vec_sub(p->vertex[v], middle)));
    line.rim = RIM * (line.rim + radius);
    cross_all(&line);
    const double first = to_base + line.first, last = to_base + line.last;
    if (!(first <= way && last >= 0))
        return (pir_entry){.hits = false, .time = 1};
    if (first < 0)
        return (pir_entry){true, true, 0, normal_of_depth(p, segment->from, against), 0};
    return (pir_entry){true, false, first / way, line.normal, 0};
}
