/* SPDX-License-Identifier: MIT */
/*
 * The short ways to a manifold find what the long ones find: outlines in general position, clipped by signs, share
 * the corners that merging and a hull find; and where a patch is told to be one facet, growing ends at that facet.
 */
#include "support/test.h"

#include <math.h>
#include <string.h>

#include "base/processor.h"
#include "query/contact/clip.h"
#include "query/contact/single.h"
#include "support/bodies.h"

#define SNAP 1e-13
#define PART 1e-6
#define MOST (3 * PIR_CLIP_MOST + 4)

static const double pi = 3.14159265358979323846;

typedef struct points {
    uint32_t count;
    pir_corner at[MOST];
} points;

/* --- outlines --- */

/* A convex outline: corners on an ellipse, or with `number` even on a small grid, so that sides are flush. */
static points outline(test_random *random, uint64_t number) {
    points p = {.count = 3 + test_random_below(random, 8)};
    pir_corner room[MOST + 1];
    double x = 0.5 * test_random_unit(random), y = 0.5 * test_random_unit(random), size = 1;
    if (number % 8 == 3)
        size = 1e-6;
    for (uint32_t i = 0; i < p.count; i++) {
        double angle = 2 * pi * (i + 0.8 * test_random_unit(random)) / p.count;
        double u = x + size * cos(angle), v = y + 0.7 * size * sin(angle);
        if (number % 2 == 0) {
            u = test_random_between(random, -2, 2);
            v = test_random_between(random, -2, 2);
        }
        p.at[i] = (pir_corner){.u = u + 1e-15 * test_random_unit(random), .v = v, .p = i};
    }
    p.count = pir_outline_hull(p.at, p.count, SNAP, room);
    return p;
}

static bool is_slim(points p) {
    return pir_outline_slim(p.at, p.count, PART) < p.count;
}

/* Whether it is no segment, and every corner is clear of the line through its neighbours. */
static bool is_clear(const points *p) {
    bool clear = p->count > 2 && !is_slim(*p);
    for (uint32_t i = 0; i < p->count; i++) {
        const pir_corner *a = &p->at[i], *b = &p->at[(i + 1) % p->count], *c = &p->at[(i + 2) % p->count];
        double cross = (b->u - a->u) * (c->v - a->v) - (b->v - a->v) * (c->u - a->u);
        clear &= cross > PIR_CLIP_CLEAR * SNAP * pir_outline_distance(a, c);
    }
    return clear;
}

static bool is_corner(const pir_corner *a, const pir_corner *b) {
    return a->kind == b->kind && a->p == b->p && a->q == b->q && pir_outline_distance(a, b) < 1e-11;
}

static bool same_cycle(const points *a, const points *b) {
    for (uint32_t shift = 0; shift < a->count && a->count == b->count; shift++) {
        uint32_t same = 0;
        while (same < a->count && is_corner(&a->at[same], &b->at[(same + shift) % b->count]))
            same++;
        if (same == a->count)
            return true;
    }
    return a->count == 0 && b->count == 0;
}

/* The corners that both share, by the plain version; PIR_CLIP_UNCLEAR where signs do not tell. */
static uint32_t clip_plain(pir_outline p, pir_outline q, double snap, pir_corner *ret_corners) {
    pir_clip_places places;
    return pir_clip_place(p, q, snap, &places) ? pir_clip_corners(p, q, snap, &places, ret_corners) : PIR_CLIP_UNCLEAR;
}

static void clipping_finds_what_merging_finds(void **state) {
    (void)state;
    int told = 0, parted = 0, asked = 0;
    for (uint64_t number = 0; number < 20000; number++) {
        test_random random = test_random_case("clip", number);
        points p = outline(&random, number), q = outline(&random, number), merged = {0}, clipped = {0};
        pir_corner room[MOST + 1];
        pir_outline of_p = {p.at, p.count}, of_q = {q.at, q.count};
        if (!is_clear(&p) || !is_clear(&q))
            continue;
        asked += (int)(number % 2);
        clipped.count = clip_plain(of_p, of_q, SNAP, clipped.at);
        if (clipped.count == PIR_CLIP_UNCLEAR)
            continue;
        merged.count = pir_outline_overlap(of_p, of_q, SNAP, PART, merged.at);
        merged.count = pir_outline_hull(merged.at, merged.count, SNAP, room);
        expect(same_cycle(&merged, &clipped), "case %d: %u corners, not %u", (int)number, clipped.count, merged.count);
        told += (int)(number % 2);
        parted += clipped.count == 0;
    }
    print_message("# %d of %d pairs in general position told, %d apart\n", told, asked, parted);
    assert_true(told > 0.99 * asked && asked > 5000 && parted > 500);
}

/* What is flush, equal or beside is not told. */
static void flush_outlines_are_unclear(void **state) {
    (void)state;
    const pir_corner square[4] = {{.u = 0, .v = 0}, {.u = 1, .v = 0}, {.u = 1, .v = 1}, {.u = 0, .v = 1}};
    for (int i = 0; i < 3; i++) {
        pir_corner moved[4], shared[8];
        for (int k = 0; k < 4; k++)
            moved[k] = (pir_corner){.u = square[k].u + (i > 0), .v = square[k].v + (i > 1 ? 1 : 0.25 * i)};
        pir_outline p = {square, 4}, q = {moved, 4};
        assert_true(clip_plain(p, q, SNAP, shared) == PIR_CLIP_UNCLEAR);
    }
    // too many corners
    pir_corner many[PIR_CLIP_MOST + 1], shared[2 * PIR_CLIP_MOST + 1];
    for (int i = 0; i <= PIR_CLIP_MOST; i++)
        many[i] = (pir_corner){.u = cos(2 * pi * i / (PIR_CLIP_MOST + 1)), .v = sin(2 * pi * i / (PIR_CLIP_MOST + 1))};
    pir_outline all = {many, PIR_CLIP_MOST + 1}, far = {square, 4};
    assert_true(clip_plain(all, far, SNAP, shared) == PIR_CLIP_UNCLEAR);
    assert_true(clip_plain(far, all, SNAP, shared) == PIR_CLIP_UNCLEAR);
}

/* --- single facets --- */

static double size_of(const pir_polytope *p) {
    double most = 0;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        most = fmax(most, sqrt(pir_vec_dot(p->vertex[v], p->vertex[v])));
    return most;
}

/* A patch of the body as it stands, with room for its vertices. */
static pir_patch patch_of(const pir_polytope *p, pir_vec3 out, const pir_mat3 *r, uint32_t *member, bool *is_member,
                          pir_corner *corner) {
    return (pir_patch){.version = pir_processor_best()->single,
                       .polytope = p,
                       .vertex = p->vertex,
                       .r = r,
                       .sign = r ? -1 : 1,
                       .out = out,
                       .snap = 2 * PIR_SNAP * size_of(p),
                       .member = member,
                       .is_member = is_member,
                       .corner = corner};
}

/* Whether growing from the feature, and by one facet where it has no area, ends at the corners of f alone. */
static bool grows_to(pir_patch *patch, pir_feature feature, uint32_t f) {
    const pir_polytope *p = patch->polytope;
    pir_patch_grow(patch, feature);
    bool grown = feature.kind == PIR_FEATURE_FACET || pir_patch_extend(patch);
    uint32_t on = 0, size = p->loop_start[f + 1] - p->loop_start[f];
    for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
        on += patch->is_member[p->origin[p->loop[i]]];
    grown &= on == size && patch->members == size;
    pir_patch_clear(patch);
    return grown;
}

static bool is_in(const pir_patch *patch, const pir_corner *x) {
    bool in = false;
    for (uint32_t i = 0; i < patch->outline.count; i++)
        in |= patch->outline.at[i].p == x->p && pir_outline_distance(&patch->outline.at[i], x) == 0;
    return in;
}

/* The outline of a single facet is the hull of its corners, none left out, and each is on its plane. */
static void check_outline(pir_patch *patch, const pir_single *single, uint64_t number) {
    pir_corner hull[PIR_CLIP_MOST], room[PIR_CLIP_MOST + 1];
    pir_vec3 n = pir_vec_scale(patch->out, patch->sign), least = {fabs(n.x) < 0.6, fabs(n.x) >= 0.6, 0};
    pir_vec3 u = pir_vec_cross(n, least), axis[3] = {pir_vec_scale(u, 1 / sqrt(pir_vec_dot(u, u)))};
    axis[1] = pir_vec_cross(n, axis[0]);
    axis[2] = n;
    pir_patch_set_single(patch, single, axis);
    uint32_t count = patch->outline.count;
    for (uint32_t i = 0; i < count; i++) {
        hull[i] = patch->outline.at[i];
        double off = pir_vec_dot(n, pir_patch_vertex(patch, hull[i].p)) - pir_patch_height(patch, &hull[i]);
        expect(fabs(off) < 8 * patch->snap, "case %d: corner %u of facet %u is %.3g off its plane", (int)number, i,
               single->facet, off);
    }
    expect(pir_outline_hull(hull, count, patch->snap, room) == count &&
               pir_outline_slim(hull, count, PIR_FLUSH) == count,
           "case %d: facet %u has corners that do not stand out", (int)number, single->facet);
    for (uint32_t i = 0; i < count; i++)
        expect(is_in(patch, &hull[i]), "case %d: corner %u of facet %u", (int)number, hull[i].p, single->facet);
}

/* The patch of a feature in a direction that it carries an answer in, or nearly. Returns whether it is one facet. */
static bool check_feature(pir_patch *patch, test_random *random, pir_feature feature, uint64_t number) {
    const pir_polytope *p = patch->polytope;
    uint32_t half = feature.kind == PIR_FEATURE_EDGE     ? p->edge_half[feature.index]
                    : feature.kind == PIR_FEATURE_VERTEX ? p->ring_start[feature.index]
                                                         : p->loop[p->loop_start[feature.index]];
    pir_vec3 n = p->normal[p->left[half]], m = p->normal[pir_right(p, half)], d = test_random_direction(random);
    double part = feature.kind == PIR_FEATURE_FACET ? 1 : 0.5 + 0.4 * test_random_unit(random);
    double tilt = ldexp(1, -test_random_between(random, 1, 50));
    pir_vec3 out = pir_vec_add(pir_vec_add(pir_vec_scale(n, part), pir_vec_scale(m, 1 - part)), pir_vec_scale(d, tilt));
    out = pir_vec_scale(out, 1 / sqrt(pir_vec_dot(out, out)));
    patch->out = pir_vec_scale(patch->r ? pir_mat_apply(patch->r, out) : out, patch->sign);
    pir_single single, again;
    pir_kept_shape *kept = patch->kept;
    patch->kept = NULL;
    bool is_single = pir_patch_single(patch, feature, &single);
    pir_facet_shape shape = patch->shape;
    patch->kept = kept;
    // with shapes that are kept, whether this one is known or not
    expect(pir_patch_single(patch, feature, &again) == is_single, "case %d: kept", (int)number);
    expect(!is_single || (again.facet == single.facet && memcmp(&patch->shape, &shape, sizeof shape) == 0),
           "case %d: the kept shape of facet %u", (int)number, single.facet);
    if (is_single) {
        expect(grows_to(patch, feature, single.facet), "case %d: feature %d %u grows beyond facet %u", (int)number,
               (int)feature.kind, feature.index, single.facet);
        check_outline(patch, &single, number);
    }
    if (feature.kind != PIR_FEATURE_FACET && pir_patch_is_sharp(patch, feature)) {
        pir_patch_grow(patch, feature);
        expect(patch->members == (uint32_t)feature.kind, "case %d: feature %d %u grows", (int)number, (int)feature.kind,
               feature.index);
        pir_patch_clear(patch);
    }
    return is_single;
}

typedef bool check_patch(pir_patch *patch, test_random *random, pir_feature feature, uint64_t number);

/* Checks patches of features of bodies, of which more than a third are to be what the check looks for. */
static void check_patches(const char *what, check_patch *check) {
    static uint32_t member[TEST_POINTS_MAX];
    static bool is_member[TEST_POINTS_MAX];
    static pir_corner corner[TEST_POINTS_MAX];
    static pir_kept_shape kept[2 * TEST_POINTS_MAX];
    int found = 0, asked = 0;
    for (uint64_t number = 0; number < 600; number++) {
        test_random random = test_random_case(what, number);
        test_points at;
        test_body_points(&random, (test_body)(number % TEST_BODY_COUNT), 4 + number % 20, &at);
        if (number % 3 == 0)
            test_bake(&at, test_general_rotation(&random));
        pir_polytope *p = test_polytope(&at);
        pir_mat3 r = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
        pir_patch patch = patch_of(p, (pir_vec3){0, 0, 1}, number % 2 ? &r : NULL, member, is_member, corner);
        for (uint32_t f = 0; f < p->facet_count; f++)
            pir_kept_shape_clear(&kept[f]);
        patch.kept = kept;
        const uint32_t counts[3] = {p->vertex_count, p->edge_count, p->facet_count};
        for (int i = 0; i < 60 && p->dimension > 1; i++) {
            pir_feature feature = {(pir_feature_kind)(PIR_FEATURE_VERTEX + i % 3), 0};
            feature.index = test_random_below(&random, counts[i % 3]);
            found += check(&patch, &random, feature, number);
            asked++;
        }
        pir_polytope_release(p);
    }
    print_message("# %d of %d patches are %s\n", found, asked, what);
    assert_true(3 * found > asked);
}

static void single_facets_are_what_growing_ends_at(void **state) {
    (void)state;
    check_patches("single facets", check_feature);
}

/* Whether one facet is told to be what grows; then growing gives it with the same outline, to the bit. */
static bool check_flat(pir_patch *patch, test_random *random, pir_feature feature, uint64_t number) {
    const pir_polytope *p = patch->polytope;
    uint32_t half = feature.kind == PIR_FEATURE_EDGE     ? p->edge_half[feature.index]
                    : feature.kind == PIR_FEATURE_VERTEX ? p->ring_start[feature.index]
                                                         : p->loop[p->loop_start[feature.index]];
    pir_vec3 d = test_random_direction(random), axis[2] = {{1, 0, 0}, {0, 1, 0}};
    double tilt = test_random_below(random, 3) ? ldexp(1, -test_random_between(random, 18, 50)) : 0;
    pir_vec3 out = pir_vec_add(p->normal[p->left[half]], pir_vec_scale(d, tilt));
    out = pir_vec_scale(out, 1 / sqrt(pir_vec_dot(out, out)));
    patch->out = pir_vec_scale(patch->r ? pir_mat_apply(patch->r, out) : out, patch->sign);
    // where the facet's sides are along the axes, two corners are first but for rounding
    pir_vec3 n = pir_vec_scale(patch->out, patch->sign), side = p->direction[half];
    axis[0] = pir_vec_scale(patch->r ? pir_mat_apply(patch->r, side) : side, patch->sign);
    axis[1] = pir_vec_cross(n, axis[0]);
    static pir_corner room[TEST_POINTS_MAX + 1];
    pir_corner flat[PIR_CLIP_MOST];
    uint32_t facet = pir_patch_flat(patch, feature);
    if (facet == PIR_NO_FACET)
        return false;
    pir_patch_set_flat(patch, facet, axis, room);
    uint32_t count = patch->outline.count;
    memcpy(flat, patch->outline.at, count * sizeof *flat);
    pir_patch_grow(patch, feature);
    pir_patch_set_outline(patch, axis, room);
    pir_patch_clear(patch);
    bool same = patch->facet == facet && patch->outline.count == count;
    for (uint32_t i = 0; i < count && same; i++)
        same = memcmp(&flat[i].u, &patch->outline.at[i].u, sizeof flat[i].u) == 0 &&
               memcmp(&flat[i].v, &patch->outline.at[i].v, sizeof flat[i].v) == 0 &&
               flat[i].p == patch->outline.at[i].p;
    expect(same, "case %d: feature %d %u does not grow to facet %u", (int)number, (int)feature.kind, feature.index,
           facet);
    return true;
}

static void flat_facets_are_what_grows(void **state) {
    (void)state;
    check_patches("flat facets", check_flat);
}

/* A patch whose every bit is known, with corners of its own. */
static pir_patch singled(const pir_patch *patch, pir_corner corner[PIR_CLIP_MOST]) {
    pir_patch copy;
    memcpy(&copy, patch, sizeof copy);
    copy.corner = corner;
    memset(corner, 0, PIR_CLIP_MOST * sizeof *corner);
    return copy;
}

static void check_same_single(const pir_patch *a, const pir_patch *b) {
    const double of_a[3] = {a->height, a->along_u, a->along_v}, of_b[3] = {b->height, b->along_u, b->along_v};
    assert_memory_equal(of_a, of_b, sizeof of_a);
    assert_int_equal(a->outline.count, b->outline.count);
    assert_memory_equal(a->corner, b->corner, PIR_CLIP_MOST * sizeof *a->corner);
}

/* Every version sets outlines, planes and places of single facets with the bits of the plain one. */
static void versions_place_singles_alike(void **state) {
    (void)state;
    int clear = 0;
    for (uint64_t number = 0; number < 4000; number++) {
        test_random random = test_random_case("singles", number);
        test_points at;
        test_body_points(&random, (test_body)(number % TEST_BODY_COUNT), 4 + number % 20, &at);
        pir_polytope *body = test_polytope(&at);
        pir_mat3 r = {{{0, -0.6, 0.8}, {1, 0, 0}, {0, 0.8, 0.6}}};
        pir_vec3 n = test_random_direction(&random), side = {fabs(n.x) < 0.6, fabs(n.x) >= 0.6, 0};
        pir_vec3 u = pir_vec_cross(n, side), axis[3] = {pir_vec_scale(u, 1 / sqrt(pir_vec_dot(u, u)))};
        axis[1] = pir_vec_cross(n, axis[0]);
        axis[2] = n;
        pir_patch p = patch_of(body, pir_vec_scale(n, -1), &r, NULL, NULL, NULL), q = p;
        q.r = NULL;
        q.sign = 1;
        p.at = pir_vec_scale(test_random_direction(&random), 0.2 * size_of(body));
        p.at.z = number % 3 ? p.at.z : 0;
        for (int i = 0; i < 10 && body->dimension > 1; i++) {
            static pir_clip_places plain, places;
            pir_corner corner[4][PIR_CLIP_MOST];
            const pir_single of_p = {test_random_below(&random, body->facet_count), UINT32_MAX, 1},
                             of_q = {test_random_below(&random, body->facet_count), UINT32_MAX, 1};
            pir_patch p0 = singled(&p, corner[0]), q0 = singled(&q, corner[1]);
            // more corners than the plain version looks at have no room here
            if (body->loop_start[of_p.facet + 1] - body->loop_start[of_p.facet] > PIR_CLIP_MOST ||
                body->loop_start[of_q.facet + 1] - body->loop_start[of_q.facet] > PIR_CLIP_MOST)
                continue;
            bool is_clear = pir_processor_version(0)->single->place(&p0, &of_p, &q0, &of_q, axis, &plain);
            clear += is_clear;
            for (unsigned version = 1; pir_processor_version(version); version++) {
                pir_patch p1 = singled(&p, corner[2]), q1 = singled(&q, corner[3]);
                assert_int_equal(pir_processor_version(version)->single->place(&p1, &of_p, &q1, &of_q, axis, &places),
                                 is_clear);
                check_same_single(&p0, &p1);
                check_same_single(&q0, &q1);
                for (uint32_t j = 0; j < q0.outline.count; j++)
                    assert_memory_equal(places.inside[j], plain.inside[j],
                                        p0.outline.count * sizeof plain.inside[j][0]);
                assert_int_equal(places.entering, plain.entering);
                assert_int_equal(places.leaving, plain.leaving);
            }
        }
        pir_polytope_release(body);
    }
    print_message("# %d pairs of facets are clear\n", clear);
    assert_true(clear > 1000);
}

/* A direction in which edges and facets of a body may be flat, equally near or foremost, but for rounding. */
static pir_vec3 nearly_facing(const pir_polytope *p, test_random *random, uint32_t half) {
    pir_vec3 n = p->normal[p->left[half]], m = p->normal[pir_right(p, half)], d = test_random_direction(random);
    const pir_vec3 some[4] = {n, pir_vec_add(n, m), pir_vec_cross(p->direction[half], d), d};
    pir_vec3 out = some[test_random_below(random, 4)];
    out = pir_vec_add(
        out, pir_vec_scale(d, test_random_below(random, 3) ? ldexp(1, -test_random_between(random, 8, 50)) : 0));
    double square = pir_vec_dot(out, out);
    return square > 0 ? pir_vec_scale(out, 1 / sqrt(square)) : n;
}

/* Every version tells sharp features and foremost facets with the bits of the plain one, ties included. */
static void versions_look_around_alike(void **state) {
    (void)state;
    const pir_single_version *plain = pir_processor_version(0)->single;
    int sharp = 0, found = 0, asked = 0;
    for (uint64_t number = 0; number < 2000; number++) {
        test_random random = test_random_case("rings", number);
        test_points at;
        test_body_points(&random, (test_body)(number % TEST_BODY_COUNT), 4 + number % 40, &at);
        pir_polytope *p = test_polytope(&at);
        const uint32_t counts[2] = {p->vertex_count, p->edge_count};
        for (int i = 0; i < 40 && p->dimension > 0; i++) {
            pir_feature feature = {(pir_feature_kind)(PIR_FEATURE_VERTEX + i % 2),
                                   // the last ones, behind which the arrays end, as often as others
                                   test_random_below(&random, counts[i % 2])};
            feature.index = i % 4 < 2 ? feature.index : counts[i % 2] - 1;
            uint32_t half =
                feature.kind == PIR_FEATURE_EDGE ? p->edge_half[feature.index] : p->ring_start[feature.index];
            pir_vec3 out = nearly_facing(p, &random, half);
            // also what an edge falls by, to the bit
            double slope = fabs(pir_vec_dot(out, p->direction[half])), sine = i % 5 && slope < 1 ? PIR_FLAT : slope;
            bool is_sharp = plain->is_sharp(p, feature, out, sine);
            pir_foremost foremost = {UINT32_MAX, 0};
            if (feature.kind == PIR_FEATURE_VERTEX)
                foremost = plain->foremost(p, feature.index, out, sine);
            sharp += is_sharp;
            found += foremost.half != UINT32_MAX;
            asked++;
            for (unsigned version = 1; pir_processor_version(version); version++) {
                const pir_single_version *other = pir_processor_version(version)->single;
                expect(other->is_sharp(p, feature, out, sine) == is_sharp, "case %d: feature %d %u", (int)number,
                       (int)feature.kind, feature.index);
                if (feature.kind != PIR_FEATURE_VERTEX)
                    continue;
                pir_foremost again = other->foremost(p, feature.index, out, sine);
                expect(
                    again.half == foremost.half &&
                        (again.half == UINT32_MAX || memcmp(&again.cosine, &foremost.cosine, sizeof again.cosine) == 0),
                    "case %d: vertex %u", (int)number, feature.index);
            }
        }
        pir_polytope_release(p);
    }
    print_message("# of %d features %d are sharp, at %d vertices a facet is foremost\n", asked, sharp, found);
    assert_true(4 * sharp > asked && 12 * found > asked && sharp < asked);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clipping_finds_what_merging_finds),      cmocka_unit_test(flush_outlines_are_unclear),
        cmocka_unit_test(single_facets_are_what_growing_ends_at), cmocka_unit_test(flat_facets_are_what_grows),
        cmocka_unit_test(versions_place_singles_alike),           cmocka_unit_test(versions_look_around_alike)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
