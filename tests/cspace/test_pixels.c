/* SPDX-License-Identifier: MIT */
/*
 * The map of the sphere below the grid of all rotations, held against the formulas of Górski et al., Astrophysical J.
 * 622 (2005), in the ring numbering, which share nothing with ours, and against the figures that they print.
 */
#include "support/test.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "cspace/grid/angle.h"
#include "cspace/grid/pixel.h"
#include "support/random.h"

#define PI 3.14159265358979323846

struct direction {
    double z, phi;
};

static struct direction centre(uint32_t level, pir_pixel pixel) {
    pir_pixel_centre c = pir_pixel_centre_of(level, pixel);
    return (struct direction){c.upper - c.lower, 2 * PI * c.num / c.den};
}

static double angle_between(struct direction a, struct direction b) {
    double dz = a.z - b.z, r = sqrt(1 - a.z * a.z), s = sqrt(1 - b.z * b.z);
    double across = r * r + s * s - 2 * r * s * cos(a.phi - b.phi);
    return 2 * asin(fmin(1, sqrt(fmax(0, across) + dz * dz) / 2));
}

/* Equations 4 to 9 of the paper: pixel j, from 1, of ring i, from 1 in the north. */
static struct direction published(int n, int i, int j) {
    if (i < n)
        return (struct direction){1 - i * i / (3.0 * n * n), PI / (2 * i) * (j - 0.5)};
    if (i <= 3 * n)
        return (struct direction){4.0 / 3 - 2 * i / (3.0 * n), PI / (2 * n) * (j - ((i - n + 1) % 2) / 2.0)};
    struct direction north = published(n, 4 * n - i, j);
    return (struct direction){-north.z, north.phi};
}

static void the_centres_are_those_of_the_paper(void **state) {
    (void)state;
    for (uint32_t level = 0; level <= 5; level++) {
        const int n = 1 << level;
        uint32_t seen = 0;
        for (int i = 1; i < 4 * n; i++) {
            uint32_t count = pir_pixel_circle_count(level, 2 * n - i);
            assert_int_equal(count, 4 * (i < n ? i : i > 3 * n ? 4 * n - i : n));
            // where a pixel is at longitude 0 it is our first and the paper's last
            const bool at_zero = pir_pixel_circle_first(level, 2 * n - i) == 0;
            for (uint32_t k = 0; k < count; k++) {
                pir_pixel pixel = pir_pixel_on_circle(level, 2 * n - i, k);
                struct direction ours = centre(level, pixel), theirs = published(n, i, (int)k + !at_zero);
                assert_true(fabs(ours.z - theirs.z) < 1e-15);
                double off = ours.phi - theirs.phi;
                expect(fabs(off - 2 * PI * round(off / (2 * PI))) < 1e-14, "level %u ring %d pixel %u", level, i, k);
                seen++;
            }
        }
        assert_int_equal(seen, 12 * n * n);
    }
}

/* Table 1 of the paper: the angular size of pixels, the root of their area, in degrees and minutes. */
static void the_size_of_pixels_is_the_published_one(void **state) {
    (void)state;
    static const double published_size[] = {58.6, 29.3, 14.7, 7.33, 3.66, 1.83, 55.0 / 60, 27.5 / 60};
    for (uint32_t level = 0; level < 8; level++) {
        double count = 12 * pow(4, level), size = sqrt(4 * PI / count) * 180 / PI;
        assert_true(fabs(size / published_size[level] - 1) < 0.005);
    }
    // The centre of pixel 0 at level 0 is where the paper's figure has it; the largest distance from a centre to the
    // edge of its pixel is that of the polar ones, acos(2/3) = 48.19°.
    assert_true(fabs(centre(0, (pir_pixel){0, 0, 0}).z - 2.0 / 3) < 1e-15);
    assert_true(fabs(centre(0, (pir_pixel){0, 0, 0}).phi - PI / 4) < 1e-15);
    assert_true(fabs(angle_between(centre(0, (pir_pixel){0, 0, 0}), (struct direction){1, 0}) * 180 / PI - 48.19) <
                0.005);
}

/* The children of a pixel have its number times four, plus 0 to 3, and lie in it. */
static void nested_numbers_nest(void **state) {
    (void)state;
    for (uint32_t level = 1; level <= 6; level++) {
        const uint32_t side = 1u << level;
        uint8_t *seen = calloc((size_t)12 * side * side, 1);
        for (uint32_t k = 0; k < 12 * side * side; k++) {
            pir_pixel pixel = {k / (side * side), k / side % side, k % side};
            pir_pixel parent = {pixel.face, pixel.i / 2, pixel.j / 2};
            uint64_t nested = pir_pixel_nested(level, pixel);
            assert_true(nested < 12 * side * side && seen[nested]++ == 0);
            assert_int_equal(nested / 4, pir_pixel_nested(level - 1, parent));
            assert_int_equal(nested % 4, pixel.i % 2 + 2 * (pixel.j % 2));
            // the largest pixels reach this far from their centres
            assert_true(angle_between(centre(level, pixel), centre(level - 1, parent)) < 0.8411 * 2 / side);
        }
        free(seen);
    }
}

static void latitudes_go_there_and_back(void **state) {
    (void)state;
    for (uint32_t level = 0; level <= 8; level++)
        for (int32_t y = 1 - (2 << level); y < 2 << level; y++) {
            double z = pir_pixel_z_of(level, y);
            assert_true(fabs(pir_pixel_y_of(level, z) - y) < 1e-6);
            assert_true(fabs(centre(level, pir_pixel_on_circle(level, y, 0)).z - z) < 1e-15);
        }
}

static void the_path_goes_from_neighbour_to_neighbour(void **state) {
    (void)state;
    for (uint32_t level = 0; level <= 6; level++) {
        uint32_t count = 12u << (2 * level);
        double size = PI / 3 / ((uint32_t)1 << level), longest = 0;
        uint8_t *seen = calloc(count, 1);
        struct direction before = {0, 0};
        for (uint32_t rank = 0; rank < count; rank++) {
            pir_pixel pixel = pir_pixel_path_at(level, rank);
            assert_int_equal(pir_pixel_path_rank(level, pixel), rank);
            assert_int_equal(seen[pir_pixel_nested(level, pixel)]++, 0);
            struct direction at = centre(level, pixel);
            longest = fmax(longest, rank ? angle_between(before, at) : 0);
            before = at;
        }
        free(seen);
        printf("# level %u: the longest step of the path is %.3f of 60° / 2^level\n", level, longest / size);
        assert_true(longest < 1.45 * size);
    }
}

static void angles_are_those_of_the_c_library(void **state) {
    (void)state;
    test_random random = test_random_case("angles", 0);
    for (int i = 0; i < 20000; i++) {
        uint64_t den = 1 + test_random_bits(&random) % (i % 2 ? 1000 : (uint64_t)1 << 60);
        uint64_t num = test_random_bits(&random) >> 3;
        pir_circle_point p = pir_circle_at(num, den);
        double angle = 2 * PI * ((double)(num % den) / (double)den);
        // the angle itself is off by some 2^-51 here
        expect(fabs(p.cos - cos(angle)) < 0x1p-49 && fabs(p.sin - sin(angle)) < 0x1p-49, "case %d", i);
        assert_true(fabs(p.cos * p.cos + p.sin * p.sin - 1) < 0x1p-51);
        double part = pir_turn_part(p.cos, p.sin), whole = (double)(num % den) / (double)den;
        assert_true(part >= 0 && part < 1 && fabs(remainder(part - whole, 1)) < 0x1p-50);
    }
    for (uint64_t quarter = 0; quarter < 4; quarter++) {
        pir_circle_point p = pir_circle_at(quarter * 25, 100), q = pir_circle_at(2 * quarter + 1, 8);
        assert_true(p.cos == (quarter == 0) - (quarter == 2) && p.sin == (quarter == 1) - (quarter == 3));
        assert_true(fabs(q.cos) == fabs(q.sin));
    }
    assert_true(pir_turn_part(0, 0) == 0 && pir_turn_part(1, -0x1p-1000) == 0 && pir_turn_part(-1, 0) == 0.5);
}

int main(void) {
    test_print_seed();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_centres_are_those_of_the_paper),
        cmocka_unit_test(the_size_of_pixels_is_the_published_one),
        cmocka_unit_test(nested_numbers_nest),
        cmocka_unit_test(latitudes_go_there_and_back),
        cmocka_unit_test(the_path_goes_from_neighbour_to_neighbour),
        cmocka_unit_test(angles_are_those_of_the_c_library),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
