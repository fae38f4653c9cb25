/* SPDX-License-Identifier: MIT */
/*
 * Pictures of bodies, read back number by number: the facets that face the viewer and no others, each corner where an
 * orthographic view in doubles puts it, shades that follow the light, a legend of the kinds that are seen.
 */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include <pirouette/pirouette.h>

#include "polytope/write/write_svg.h"
#include "support/bodies.h"
#include "support/test.h"
#include "support/vectors.h"

/* The space around a body, and its longer side, in units of the picture. */
#define MARGIN 24.0
#define LONGER 560.0

/* Two decimals are written, and floats see a body of this size. */
#define NEAR 0.012

struct view {
    pir_vec3 right, up, viewer, light;
};

/* From azimuth 35° and elevation 25°; the light comes over the left shoulder. */
static struct view view_of_pictures(void) {
    const double degree = acos(-1) / 180, a = 35 * degree, e = 25 * degree;
    struct view view = {.right = {-sin(a), cos(a), 0},
                        .up = {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)},
                        .viewer = {cos(e) * cos(a), cos(e) * sin(a), sin(e)}};
    view.light = test_add(test_add(test_add(test_zero, view.right, -0.4), view.up, 0.67), view.viewer, 0.625);
    return view;
}

/* The picture of a mesh as a string for free(). */
static char *picture_of(const pir_mesh *mesh) {
    FILE *file = tmpfile();
    assert_non_null(file);
    assert_int_equal(pir_mesh_write_stream(mesh, file, "picture", "svg", 0, NULL), PIR_OK);
    size_t size = (size_t)ftell(file);
    char *text = calloc(size + 1, 1);
    assert_non_null(text);
    rewind(file);
    assert_int_equal(fread(text, 1, size, file), size);
    fclose(file);
    return text;
}

/* Where a view in doubles puts a point, y upwards. */
static void see(const struct view *view, pir_vec3 point, double ret_xy[2]) {
    ret_xy[0] = test_dot(view->right, point);
    ret_xy[1] = test_dot(view->up, point);
}

/* A body's projection: its bounds, and what turns it into the picture. */
struct frame {
    double low[2], high[2], scale, x, y;
};

static struct frame frame_of(const struct view *view, const pir_mesh *mesh, double width) {
    struct frame frame = {.low = {HUGE_VAL, HUGE_VAL}, .high = {-HUGE_VAL, -HUGE_VAL}};
    for (uint32_t v = 0; v < pir_mesh_vertex_count(mesh); v++) {
        double xy[2];
        see(view, pir_mesh_vertices(mesh)[v], xy);
        for (int k = 0; k < 2; k++) {
            frame.low[k] = fmin(frame.low[k], xy[k]);
            frame.high[k] = fmax(frame.high[k], xy[k]);
        }
    }
    double longer = fmax(frame.high[0] - frame.low[0], frame.high[1] - frame.low[1]);
    frame.scale = longer > 0 ? LONGER / longer : 0;
    frame.x = width / 2 - frame.scale * (frame.low[0] + frame.high[0]) / 2;
    frame.y = MARGIN + frame.scale * frame.high[1];
    return frame;
}

/* Twice the area vector of a facet. */
static pir_vec3 area_of(const pir_mesh *mesh, const uint32_t *corner, uint32_t count) {
    const pir_vec3 *at = pir_mesh_vertices(mesh);
    pir_vec3 sum = test_zero;
    for (uint32_t i = 1; i + 1 < count; i++)
        sum = test_add(
            sum, test_cross(test_add(at[corner[i]], at[corner[0]], -1), test_add(at[corner[i + 1]], at[corner[0]], -1)),
            1);
    return sum;
}

/* A path of the picture, and how bright the facet is that it shows. */
struct path {
    unsigned colour[3];
    double lit;
    pir_facet_kind kind;
};

/* Reads one path at `text`, which must be that of the facet; returns what follows it. */
static const char *read_path(const char *text, const struct view *view, const struct frame *frame, const pir_mesh *mesh,
                             uint32_t facet, struct path *ret_path) {
    int used = 0;
    assert_int_equal(sscanf(text, "<path fill=\"#%2x%2x%2x\" d=\"%n", &ret_path->colour[0], &ret_path->colour[1],
                            &ret_path->colour[2], &used),
                     3);
    text += used;
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(mesh, facet, &count);
    for (uint32_t i = 0; i < count; i++) {
        double xy[2], read[2];
        char *end;
        assert_int_equal(*text, i ? 'L' : 'M');
        read[0] = strtod(text + 1, &end);
        read[1] = strtod(end, &end);
        see(view, pir_mesh_vertices(mesh)[corner[i]], xy);
        expect(fabs(read[0] - (frame->x + frame->scale * xy[0])) < NEAR &&
                   fabs(read[1] - (frame->y - frame->scale * xy[1])) < NEAR,
               "facet %u, corner %u at %g %g", facet, i, read[0], read[1]);
        text = end;
    }
    assert_int_equal(strncmp(text, "Z\"/>\n", 5), 0);
    return text + 5;
}

/* A facet that is lit more is as bright in every channel, one that is lit much more is brighter. */
static void expect_shades(const struct path *paths, uint32_t count) {
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t j = 0; j < count; j++)
            for (int k = 0; k < 3 && paths[i].kind == paths[j].kind; k++) {
                double more = paths[i].lit - paths[j].lit;
                expect(more < 1e-4 || paths[i].colour[k] >= paths[j].colour[k], "lit %g and %g", paths[i].lit,
                       paths[j].lit);
                expect(more < 0.1 || paths[i].colour[k] > paths[j].colour[k], "lit %g and %g", paths[i].lit,
                       paths[j].lit);
            }
}

/* The legend names the kinds that are seen where they are two or more; all of it is inside of the picture. */
static void expect_legend(const char *svg, unsigned kinds, double width, double height) {
    static const char *const words[4] = {"facets of P", "facets of Q", "edge pairs", "merged"};
    bool legend = (kinds & (kinds - 1)) != 0;
    const char *at = strstr(svg, "<g font-family");
    assert_int_equal(at != NULL, legend);
    // patches and words of all kinds follow each other at one distance, the whole in the middle
    double gap = pir_svg_legend_width(3) - pir_svg_legend_width(1) - pir_svg_legend_width(2);
    double next = (width - pir_svg_legend_width(kinds)) / 2, behind = 0;
    assert_true(gap > 10 && (!legend || next > MARGIN - NEAR));
    for (int kind = 0; kind < 4; kind++) {
        bool named = strstr(svg, words[kind]) != NULL;
        expect(named == (legend && (kinds >> kind & 1)), "%s in a legend of kinds %u", words[kind], kinds);
        if (!named)
            continue;
        double x, y, wide, high;
        at = strstr(at, "<rect ");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y, &wide, &high), 4);
        expect(fabs(x - next) < NEAR && y + high < height - MARGIN / 2 && y > height - 4 * MARGIN, "patch at %g", x);
        next += pir_svg_legend_width(1u << kind) + gap;
        at = strstr(at, "<text ");
        assert_non_null(at);
        assert_int_equal(sscanf(at, "<text x=\"%lf\"", &behind), 1);
        expect(behind > x + wide && behind + 30 < next - gap, "word at %g", behind);
    }
    assert_true(!legend || fabs(next - gap - (width + pir_svg_legend_width(kinds)) / 2) < NEAR);
}

/* Whether floats can tell which facets face the viewer: none is seen from its edge, none is a sliver. */
static bool is_plain(const pir_mesh *mesh) {
    const struct view view = view_of_pictures();
    double greatest = 0, least = HUGE_VAL;
    for (uint32_t f = 0; f < pir_mesh_facet_count(mesh); f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        pir_vec3 area = area_of(mesh, corner, count);
        greatest = fmax(greatest, test_length(area));
        least = fmin(least, test_length(area));
        if (!(fabs(test_dot(area, view.viewer)) > 1e-3 * test_length(area)))
            return false;
    }
    return least > 1e-4 * greatest;
}

/* A polygon in a plane across an axis, which has no extent along it. */
static void flatten(test_points *points, uint64_t axis) {
    for (size_t k = 0; k < points->count; k++) {
        pir_vec3 *at = &points->at[k];
        *(axis == 0 ? &at->x : axis == 1 ? &at->y : &at->z) = 0;
    }
}

/* Reads the whole picture against the mesh; returns the kinds of facets seen. */
static unsigned expect_picture(const pir_mesh *mesh) {
    const struct view view = view_of_pictures();
    char *svg = picture_of(mesh);
    double across, down, width, height;
    assert_int_equal(sscanf(svg,
                            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%lf\" height=\"%lf\" "
                            "viewBox=\"0 0 %lf %lf\">",
                            &across, &down, &width, &height),
                     4);
    assert_true(fabs(across - width - 0.5) < 0.5 + NEAR && fabs(down - height - 0.5) < 0.5 + NEAR);
    const struct frame frame = frame_of(&view, mesh, width);
    unsigned kinds = 0;
    uint32_t facets = pir_mesh_facet_count(mesh), drawn = 0;
    struct path *paths = calloc(facets, sizeof *paths);
    const char *at = strstr(svg, "<path");
    assert_non_null(at);
    assert_non_null(paths);
    for (uint32_t f = 0; f < facets; f++) {
        uint32_t count;
        const uint32_t *corner = pir_mesh_facet(mesh, f, &count);
        pir_vec3 area = area_of(mesh, corner, count);
        double length = test_length(area), towards = test_dot(area, view.viewer) / length;
        if (towards < 0)
            continue;
        struct path *path = &paths[drawn++];
        at = read_path(at, &view, &frame, mesh, f, path);
        path->lit = fmax(0, fmin(1, 0.5 + 0.5 * test_dot(area, view.light) / length));
        path->kind = pir_mesh_facet_kind(mesh, f);
        kinds |= 1u << path->kind;
    }
    assert_int_equal(strncmp(at, "</g>\n", 5), 0);
    expect_shades(paths, drawn);
    expect_legend(svg, kinds, width, height);
    // the picture is as large as what it shows
    double body_width = frame.scale * (frame.high[0] - frame.low[0]);
    double body_height = frame.scale * (frame.high[1] - frame.low[1]);
    bool legend = (kinds & (kinds - 1)) != 0;
    assert_true(width > body_width + 2 * MARGIN - NEAR && height > body_height + 2 * MARGIN - NEAR);
    if (!legend)
        assert_true(width < body_width + 2 * MARGIN + NEAR && height < body_height + 2 * MARGIN + NEAR);
    free(paths);
    free(svg);
    return kinds;
}

static void polytopes_are_drawn_corner_by_corner(void **state) {
    (void)state;
    uint32_t read = 0;
    for (uint64_t i = 0; i < 60; i++) {
        test_random random = test_random_case("pictures", i);
        test_points points;
        test_body_points(&random, i % 3 == 2 ? TEST_SPHERE : i % 3 == 1 ? TEST_PRISM : TEST_BALL, 40, &points);
        // in no special position, and of any size and place
        test_bake(&points, test_general_rotation(&random));
        if (i % 5 == 0)
            flatten(&points, i / 5 % 3);
        int exponent = i % 2 ? test_random_between(&random, -200, 200) : 0;
        double away = i % 4 < 2 ? 0 : 50 * test_random_unit(&random);
        for (size_t k = 0; k < points.count; k++)
            points.at[k] = (pir_vec3){ldexp(points.at[k].x + away, exponent), ldexp(points.at[k].y, exponent),
                                      ldexp(points.at[k].z - away, exponent)};
        const pir_polytope_options options = {sizeof options, NULL, ldexp(1e-12, exponent)};
        pir_polytope *p = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_polytope_create(points.at, points.count, &options, &p), PIR_OK);
        assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
        if (pir_polytope_dimension(p) >= 2 && is_plain(mesh)) {
            expect_picture(mesh);
            read++;
        }
        pir_mesh_destroy(mesh);
        pir_polytope_release(p);
    }
    expect(read > 20, "%u pictures", read);
}

static void sums_are_drawn_with_the_kinds_of_their_facets(void **state) {
    (void)state;
    unsigned all = 0;
    uint32_t mixed = 0;
    for (uint64_t i = 0; i < 40; i++) {
        test_random random = test_random_case("pictures of sums", i);
        pir_polytope *p = test_sphere(&random, 4 + test_random_below(&random, 12));
        // two of three are long and slim: the legend is wider than they are
        double slim = i % 3 ? 0.05 : 1;
        const pir_vec3 ends[4] = {{slim, 0, -9}, {0, slim, 9}, {-slim, 0, 8}, {0, -slim, -7}};
        pir_polytope *q = NULL;
        pir_sum *sum = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_polytope_create(ends, 4, NULL, &q), PIR_OK);
        assert_int_equal(pir_sum_create(p, q, test_general_rotation(&random), NULL, &sum), PIR_OK);
        assert_int_equal(pir_sum_mesh(sum, PIR_DOUBLE, &mesh), PIR_OK);
        unsigned kinds = is_plain(mesh) ? expect_picture(mesh) : 0;
        all |= kinds;
        mixed += (kinds & (kinds - 1)) != 0;
        pir_mesh_destroy(mesh);
        pir_sum_destroy(sum);
        pir_polytope_release(q);
        pir_polytope_release(p);
    }
    assert_true((all & 7) == 7 && mixed > 20);
}

/* A segment's ends and a point's place, in pictures as large as they need. */
static void thin_bodies_are_drawn_as_lines_and_dots(void **state) {
    (void)state;
    const struct view view = view_of_pictures();
    for (uint64_t i = 0; i < 20; i++) {
        test_random random = test_random_case("thin pictures", i);
        const pir_vec3 ends[2] = {test_random_direction(&random), test_random_direction(&random)};
        pir_polytope *p = NULL;
        pir_mesh *mesh = NULL;
        assert_int_equal(pir_polytope_create(ends, 2, NULL, &p), PIR_OK);
        assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
        char *svg = picture_of(mesh);
        double width = 0, read[4];
        const char *at = strstr(svg, "viewBox=\"0 0 ");
        assert_true(at && sscanf(at, "viewBox=\"0 0 %lf", &width) == 1);
        at = strstr(svg, " d=\"M");
        assert_true(at && sscanf(at, " d=\"M%lf %lfL%lf %lf\"", &read[0], &read[1], &read[2], &read[3]) == 4);
        const struct frame frame = frame_of(&view, mesh, width);
        for (uint32_t v = 0; v < 2; v++) {
            double xy[2];
            see(&view, pir_mesh_vertices(mesh)[v], xy);
            assert_true(fabs(read[2 * v] - (frame.x + frame.scale * xy[0])) < NEAR);
            assert_true(fabs(read[2 * v + 1] - (frame.y - frame.scale * xy[1])) < NEAR);
        }
        free(svg);
        pir_mesh_destroy(mesh);
        pir_polytope_release(p);
    }
    pir_polytope *p = NULL;
    pir_mesh *mesh = NULL;
    assert_int_equal(pir_polytope_create(&(pir_vec3){3, -1e9, 2}, 1, NULL, &p), PIR_OK);
    assert_int_equal(pir_mesh_from_polytope(p, &mesh), PIR_OK);
    char *svg = picture_of(mesh);
    assert_non_null(strstr(svg, "width=\"48\" height=\"48\""));
    assert_non_null(strstr(svg, "cx=\"24.00\" cy=\"24.00\""));
    free(svg);
    pir_mesh_destroy(mesh);
    pir_polytope_release(p);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polytopes_are_drawn_corner_by_corner),
        cmocka_unit_test(sums_are_drawn_with_the_kinds_of_their_facets),
        cmocka_unit_test(thin_bodies_are_drawn_as_lines_and_dots),
    };
    return cmocka_run_group_tests_name("picture", tests, NULL, NULL);
}
