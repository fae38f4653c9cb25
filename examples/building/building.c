/* SPDX-License-Identifier: MIT */
/*
 * Writes a building of extruded walls, slabs, pipes and ducts as an OBJ of several objects, for `pirouette clash`.
 *
 *     building [SOLIDS [SEED]] > building.obj
 *
 * All coordinates are whole decimetres. Each storey has a slab with a notch for the stairs, walls on the lines of a
 * grid, some with a door, and pipes and ducts that run through rooms. Mistakes are planned: walls that run into the
 * next one along their own line, pipes through walls, within walls, and walls that stand there twice.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define STOREY 30 /* decimetres from floor to floor */
#define SLAB   3
#define ROOM   40
#define ROOMS  6 /* a side */

static uint64_t state;

/* A whole number from low to high. */
static int between(int low, int high) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return low + (int)((state >> 33) % (uint64_t)(high - low + 1));
}

/* An outline of a solid, counter-clockwise as seen from above the plane of the two axes after `axis`, and how far it
 * is extruded along `axis`. */
struct extruded {
    int axis, low, high, count, corner[12][2];
};

static unsigned points; /* written so far: OBJ counts through the whole file */

static void write_solid(const char *name, unsigned number, const struct extruded *e) {
    printf("o %s_%u\n", name, number);
    for (int end = 0; end < 2; end++)
        for (int i = 0; i < e->count; i++) {
            int x[3];
            x[e->axis] = end ? e->high : e->low;
            x[(e->axis + 1) % 3] = e->corner[i][0];
            x[(e->axis + 2) % 3] = e->corner[i][1];
            printf("v %d %d %d\n", x[0], x[1], x[2]);
        }
    const unsigned n = (unsigned)e->count, low = points + 1, high = low + n;
    printf("f");
    for (unsigned i = 0; i < n; i++)
        printf(" %u", low + n - 1 - i);
    printf("\nf");
    for (unsigned i = 0; i < n; i++)
        printf(" %u", high + i);
    printf("\n");
    for (unsigned i = 0; i < n; i++)
        printf("f %u %u %u %u\n", low + i, low + (i + 1) % n, high + (i + 1) % n, high + i);
    points += 2 * n;
}

/* A rectangle extruded along z. */
static struct extruded box(int x0, int x1, int y0, int y1, int z0, int z1) {
    return (struct extruded){2, z0, z1, 4, {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}};
}

/* A slab of a storey, without a notch at one corner. */
static struct extruded slab(int floor) {
    const int side = ROOMS * ROOM, notch = between(20, 35);
    return (struct extruded){
        2,
        floor,
        floor + SLAB,
        6,
        {{0, 0}, {side, 0}, {side, side - notch}, {side - notch, side - notch}, {side - notch, side}, {0, side}}};
}

/* A wall on a line of the grid along x, 3 thick, or 2: one in four has a door, and one in five runs into the next. */
static struct extruded wall_along_x(int floor) {
    const int y = ROOM * between(0, ROOMS - 1) + 5, x = ROOM * between(0, ROOMS - 2), thick = between(2, 3);
    const int from = x, to = x + ROOM + (between(0, 4) == 0 ? 1 : 0), z = floor + SLAB, top = floor + STOREY;
    if (between(0, 3) > 0)
        return box(from, to, y, y + thick, z, top);
    // along y, from the plane of z and x: over the door, and down on both sides of it
    const int door = from + between(8, 20);
    return (struct extruded){
        1,
        y,
        y + thick,
        8,
        {{z, from}, {top, from}, {top, to}, {z, to}, {z, door + 9}, {z + 21, door + 9}, {z + 21, door}, {z, door}}};
}

static struct extruded wall_along_y(int floor) {
    const int x = ROOM * between(0, ROOMS - 1), y = ROOM * between(0, ROOMS - 2) + 5;
    return box(x, x + between(2, 3), y, y + ROOM + between(0, 1), floor + SLAB, floor + STOREY);
}

/* A pipe of a square section with a bend. */
static struct extruded pipe(int floor) {
    const int x = between(2, 200), y = between(2, 200), z = floor + between(4, 27), along = between(5, 60);
    const int across = between(5, 60);
    if (between(0, 1))
        return box(x, x + between(1, 2), y, y + along, z, z + 2);
    return (struct extruded){2,
                             z,
                             z + 2,
                             6,
                             {{x, y},
                              {x + along, y},
                              {x + along, y + across},
                              {x + along - 2, y + across},
                              {x + along - 2, y + 2},
                              {x, y + 2}}};
}

/* A riser or a duct, through slabs where it is high enough. */
static struct extruded duct(int floor) {
    const int x = between(2, 225), y = between(2, 225), wide = between(2, 8);
    return box(x, x + wide, y, y + between(2, 8), floor + between(0, 6), floor + between(15, 40));
}

int main(int count, char **argument) {
    const unsigned solids = count > 1 ? (unsigned)strtoul(argument[1], NULL, 10) : 500;
    state = count > 2 ? strtoull(argument[2], NULL, 10) : 1;
    struct extruded last = {0};
    printf("# a building of %u solids, in decimetres\n", solids);
    for (unsigned i = 0; i < solids; i++) {
        const int floor = STOREY * (int)(i / 100), kind = i % 100 == 0 ? 0 : between(1, 100);
        const char *name = kind == 0    ? "slab"
                           : kind <= 3  ? "again"
                           : kind <= 60 ? "wall"
                           : kind <= 88 ? "pipe"
                                        : "duct";
        if (kind == 0)
            last = slab(floor);
        else if (kind > 60)
            last = kind <= 88 ? pipe(floor) : duct(floor);
        else if (kind > 3)
            last = kind <= 35 ? wall_along_x(floor) : wall_along_y(floor);
        write_solid(name, i, &last);
    }
    return fflush(stdout) == 0 ? 0 : 1;
}
