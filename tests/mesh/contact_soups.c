/* SPDX-License-Identifier: MIT */
/* Soups: see contact_soups.h. */
#include "mesh/contact_soups.h"

#include <math.h>

static void add(contact_soup *soup, pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    if (soup->count == SOUP_MOST)
        return;
    soup->corner[soup->count][0] = a;
    soup->corner[soup->count][1] = b;
    soup->corner[soup->count++][2] = c;
}

static void add_quad(contact_soup *soup, pir_vec3 a, pir_vec3 b, pir_vec3 c, pir_vec3 d) {
    add(soup, a, b, c);
    add(soup, a, c, d);
}

/* A square of cells in the plane of a height, from a corner. */
static void add_grid(contact_soup *soup, pir_vec3 from, int columns, int rows, int hole) {
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            double x = from.x + i, y = from.y + j, z = from.z;
            if (j * columns + i != hole)
                add_quad(soup, (pir_vec3){x, y, z}, (pir_vec3){x + 1, y, z}, (pir_vec3){x + 1, y + 1, z},
                         (pir_vec3){x, y + 1, z});
        }
}

/* Two slopes that meet in the line y = 0, at a height. */
static void add_fold(contact_soup *soup, double rise) {
    add_quad(soup, (pir_vec3){-2, -2, 0}, (pir_vec3){2, -2, 0}, (pir_vec3){2, 0, rise}, (pir_vec3){-2, 0, rise});
    add_quad(soup, (pir_vec3){-2, 0, rise}, (pir_vec3){2, 0, rise}, (pir_vec3){2, 2, 0}, (pir_vec3){-2, 2, 0});
}

/* A long triangle beside small ones whose corners lie along its side. */
static void add_junctions(contact_soup *soup) {
    add(soup, (pir_vec3){-2, 0, 0}, (pir_vec3){0, -2, 0}, (pir_vec3){2, 0, 0});
    for (int i = 0; i < 4; i++) {
        double x = -2 + i;
        add_quad(soup, (pir_vec3){x, 0, 0}, (pir_vec3){x + 1, 0, 0}, (pir_vec3){x + 1, 1, 0}, (pir_vec3){x, 1, 0});
    }
    add(soup, (pir_vec3){-2, 1, 0}, (pir_vec3){2, 1, 0}, (pir_vec3){0, 3, 0});
}

/* The top and the inner walls of prisms that stand side by side. */
static void add_prisms(contact_soup *soup) {
    for (int i = -1; i < 2; i++) {
        double x = i;
        add(soup, (pir_vec3){x, -1, 0}, (pir_vec3){x + 1, -1, 0}, (pir_vec3){x, 1, 0});
        add(soup, (pir_vec3){x + 1, -1, 0}, (pir_vec3){x + 1, 1, 0}, (pir_vec3){x, 1, 0});
        add_quad(soup, (pir_vec3){x, -1, 0}, (pir_vec3){x, 1, 0}, (pir_vec3){x, 1, -1}, (pir_vec3){x, -1, -1});
        add_quad(soup, (pir_vec3){x, -1, 0}, (pir_vec3){x, -1, -1}, (pir_vec3){x, 1, -1}, (pir_vec3){x, 1, 0});
    }
}

static void add_step(contact_soup *soup) {
    add_quad(soup, (pir_vec3){-2, -2, 0}, (pir_vec3){0, -2, 0}, (pir_vec3){0, 2, 0}, (pir_vec3){-2, 2, 0});
    add_quad(soup, (pir_vec3){0, 2, 0.5}, (pir_vec3){0, 2, 0}, (pir_vec3){0, -2, 0}, (pir_vec3){0, -2, 0.5});
    add_quad(soup, (pir_vec3){0, -2, 0.5}, (pir_vec3){2, -2, 0.5}, (pir_vec3){2, 2, 0.5}, (pir_vec3){0, 2, 0.5});
}

static void add_any(test_random *random, contact_soup *soup) {
    for (int i = 0; i < 8; i++) {
        pir_vec3 c[3];
        for (int k = 0; k < 3; k++)
            c[k] = (pir_vec3){0.5 * test_random_between(random, -4, 4), 0.5 * test_random_between(random, -4, 4),
                              0.25 * test_random_between(random, -2, 2)};
        add(soup, c[0], c[1], c[2]);
    }
}

static void add_twice(test_random *random, contact_soup *soup) {
    uint32_t count = soup->count;
    for (uint32_t i = 0; i < count; i++) {
        const pir_vec3 *c = soup->corner[i];
        bool turned = test_random_below(random, 4) == 0;
        add(soup, c[1], turned ? c[0] : c[2], turned ? c[2] : c[0]);
    }
}

contact_soup soup_make(test_random *random, uint64_t number) {
    static const char *const names[12] = {"two triangles", "grid",  "T-junctions", "ridge", "valley", "rim",
                                          "hole",          "twice", "overlapping", "step",  "prisms", "any"};
    contact_soup soup = {.name = names[number % 12]};
    switch (number % 12) {
    case 0:
        add_quad(&soup, (pir_vec3){-2, -2, 0}, (pir_vec3){2, -2, 0}, (pir_vec3){2, 2, 0}, (pir_vec3){-2, 2, 0});
        break;
    case 1:
        add_grid(&soup, (pir_vec3){-1.5, -1, 0}, 3, 2, -1);
        break;
    case 2:
        add_junctions(&soup);
        break;
    case 3:
        add_fold(&soup, 0.25 * test_random_between(random, 1, 4));
        break;
    case 4:
        add_fold(&soup, -0.25 * test_random_between(random, 1, 4));
        break;
    case 5:
        add(&soup, (pir_vec3){-1, -1, 0}, (pir_vec3){1, -1, 0}, (pir_vec3){0, 1, 0});
        break;
    case 6:
        add_grid(&soup, (pir_vec3){-1.5, -1.5, 0}, 3, 3, 4);
        break;
    case 7:
        add_grid(&soup, (pir_vec3){-1, -1, 0}, 2, 2, -1);
        add_twice(random, &soup);
        break;
    case 8:
        add_grid(&soup, (pir_vec3){-2, -1, 0}, 2, 2, -1);
        add_grid(&soup, (pir_vec3){-0.25, -1.125, 0}, 2, 2, -1);
        break;
    case 9:
        add_step(&soup);
        break;
    case 10:
        add_prisms(&soup);
        break;
    default:
        add_any(random, &soup);
    }
    soup.split = test_random_below(random, 3) == 0;
    return soup;
}

/* A coordinate moved by a little, the same wherever it stands. */
static double moved(test_random *random, double x, int how) {
    if (how == 0)
        return test_random_below(random, 2) == 0 ? x : x == 0 ? 0x1p-53 : nextafter(x, 10);
    return x + ldexp(test_random_unit(random), how == 1 ? -10 : how == 2 ? -20 : -40);
}

void soup_jitter(test_random *random, contact_soup *soup) {
    uint32_t way = test_random_below(random, 10);
    if (way < 5)
        return;
    for (uint32_t i = 0; i < soup->count; i++)
        for (int k = 0; k < 3; k++) {
            pir_vec3 *c = &soup->corner[i][k];
            c->z = moved(random, c->z, (int)(way % 4));
            if (way > 7) {
                c->x = moved(random, c->x, (int)(way % 4));
                c->y = moved(random, c->y, (int)(way % 4));
            }
        }
}

uint32_t soup_body(uint64_t number, pir_vec3 vertex[8]) {
    static const pir_vec3 tetrahedron[4] = {{0, 0, -0.5}, {0.5, 0, 0.25}, {-0.25, 0.5, 0.25}, {-0.25, -0.5, 0.25}};
    static const pir_vec3 octahedron[6] = {{0.5, 0, 0},  {-0.5, 0, 0}, {0, 0.75, 0},
                                           {0, -0.5, 0}, {0, 0, 0.25}, {0, 0, -0.5}};
    static const pir_vec3 square[4] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}};
    static const pir_vec3 wedge[6] = {{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {-0.5, 0.5, 0},
                                      {0.5, 0.5, 0},   {0, -0.5, 0.5}, {0, 0.5, 0.5}};
    static const struct {
        const pir_vec3 *vertex;
        uint32_t count;
    } bodies[SOUP_BODIES] = {{tetrahedron, 4}, {NULL, 8},  {square, 2},    {tetrahedron, 1},
                             {square, 4},      {wedge, 6}, {octahedron, 6}};
    uint32_t count = bodies[number % SOUP_BODIES].count;
    for (uint32_t i = 0; i < count; i++)
        vertex[i] = bodies[number % SOUP_BODIES].vertex
                        ? bodies[number % SOUP_BODIES].vertex[i]
                        : (pir_vec3){i & 1 ? 0.5 : -0.5, i & 2 ? 0.25 : -0.25, i & 4 ? 0.25 : -0.25};
    return count;
}

pir_quat soup_rotation(test_random *random) {
    static const pir_quat turns[6] = {{0, 0, 0, 1}, {0, 0, 1, 2}, {1, 0, 0, 1},
                                      {1, 1, 1, 1}, {0, 0, 1, 1}, {1, 2, 0, 3}};
    if (test_random_below(random, 4) > 0)
        return turns[test_random_below(random, 6)];
    pir_vec3 d = test_random_direction(random);
    return (pir_quat){d.x, d.y, d.z, test_random_unit(random)};
}
