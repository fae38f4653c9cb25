/* SPDX-License-Identifier: MIT */
/* Floors and bodies: see sliding_floors.h. */
#include "mesh/sliding_floors.h"

#include <math.h>
#include <stdlib.h>

#include "support/random.h"

/* --- floors --- */

typedef struct soup {
    pir_vec3 (*corner)[3];
    uint32_t count, room;
} soup;

static void *checked(void *block) {
    if (!block)
        abort();
    return block;
}

static void add(soup *s, pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    if (s->count == s->room) {
        s->room = s->room ? 2 * s->room : 256;
        s->corner = checked(realloc(s->corner, s->room * sizeof *s->corner));
    }
    s->corner[s->count][0] = a;
    s->corner[s->count][1] = b;
    s->corner[s->count++][2] = c;
}

static void add_quad(soup *s, pir_vec3 a, pir_vec3 b, pir_vec3 c, pir_vec3 d) {
    add(s, a, b, c);
    add(s, a, c, d);
}

/* A prism of height 1 under a triangle of the plane z = 0. */
static void add_prism(soup *s, pir_vec3 a, pir_vec3 b, pir_vec3 c) {
    const pir_vec3 top[3] = {a, b, c};
    pir_vec3 low[3];
    for (int k = 0; k < 3; k++)
        low[k] = (pir_vec3){top[k].x, top[k].y, -1};
    add(s, a, b, c);
    add(s, low[0], low[2], low[1]);
    for (int k = 0; k < 3; k++)
        add_quad(s, top[(k + 1) % 3], top[k], low[k], low[(k + 1) % 3]);
}

static void add_surface(sliding_floor *floor, pir_surface_ref surface, pir_pose pose, double from, double to) {
    uint32_t count = floor->count + 1;
    floor->surface = checked(realloc(floor->surface, count * sizeof *floor->surface));
    floor->from = checked(realloc(floor->from, count * sizeof *floor->from));
    floor->to = checked(realloc(floor->to, count * sizeof *floor->to));
    floor->mesh = checked(realloc(floor->mesh, count * sizeof(void *)));
    floor->surface[floor->count] = (pir_posed_surface){surface, pose};
    floor->from[floor->count] = from;
    floor->to[floor->count] = to;
    floor->mesh[floor->count++] = NULL;
}

static void take_soup(sliding_floor *floor, soup *s) {
    uint32_t(*corner)[3] = checked(malloc(s->count * sizeof *corner));
    double from = HUGE_VAL, to = -HUGE_VAL;
    for (uint32_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            corner[i][k] = 3 * i + k;
            from = fmin(from, s->corner[i][k].x);
            to = fmax(to, s->corner[i][k].x);
        }
    const pir_trimesh_arrays arrays = {.vertices = s->corner,
                                       .vertex_count = 3 * (size_t)s->count,
                                       .triangles = &corner[0][0],
                                       .triangle_count = s->count};
    pir_trimesh *mesh;
    if (pir_trimesh_create(&arrays, NULL, NULL, &mesh) != PIR_OK)
        abort();
    add_surface(floor, (pir_surface_ref){mesh, NULL}, pir_pose_identity(), from, to);
    floor->mesh[floor->count - 1] = mesh;
    free(corner);
    free(s->corner);
    *s = (soup){0};
}

static void add_grid(soup *s, double from, double to, double cell, double shift) {
    for (double x = from; x < to - 1e-9; x += cell)
        for (double y = -6 + shift; y < 6; y += cell) {
            double right = fmin(x + cell, to);
            add_quad(s, (pir_vec3){x, y, 0}, (pir_vec3){right, y, 0}, (pir_vec3){right, y + cell, 0},
                     (pir_vec3){x, y + cell, 0});
        }
}

static void make_prisms(sliding_floor *floor, bool apart) {
    soup s = {0};
    for (int i = -30; i < 30; i++)
        for (int j = -7; j < 8; j++) {
            double x = i, y = j;
            const pir_vec3 a = {x, y, 0}, b = {x + 1, y, 0}, c = {x + 1, y + 1, 0}, d = {x, y + 1, 0};
            add_prism(&s, a, b, c);
            if (apart)
                take_soup(floor, &s);
            add_prism(&s, a, c, d);
            if (apart)
                take_soup(floor, &s);
        }
    if (!apart)
        take_soup(floor, &s);
}

/* Rows of cells of sizes that do not fit, so that corners lie along sides; lengths are powers of two. */
static void make_junctions(sliding_floor *floor) {
    soup s = {0};
    for (int row = 0; row < 12; row++) {
        double y = -6 + row, cell = row % 3 == 0 ? 1 : row % 3 == 1 ? 0.625 : 2.5;
        for (double x = -30; x < 30; x += cell)
            add_quad(&s, (pir_vec3){x, y, 0}, (pir_vec3){x + cell, y, 0}, (pir_vec3){x + cell, y + 1, 0},
                     (pir_vec3){x, y + 1, 0});
    }
    take_soup(floor, &s);
}

/* Two height fields that meet in a line x = const, one of cells of 1/2, the other of 3/4. */
static void make_fields(sliding_floor *floor) {
    static const float heights[128 * 32];
    const double steps[2] = {0.5, 0.75}, from[2] = {-30, 0};
    const uint32_t columns[2] = {61, 41};
    for (int i = 0; i < 2; i++) {
        const pir_height_samples samples = {.heights = heights,
                                            .type = PIR_NUMBERS_FLOAT,
                                            .columns = columns[i],
                                            .rows = 25,
                                            .step_x = steps[i],
                                            .step_y = 0.5};
        if (pir_height_field_create(&samples, NULL, NULL, &floor->field[i]) != PIR_OK)
            abort();
        pir_pose pose = {{0, 0, 0, 1}, {from[i], -6, 0}};
        add_surface(floor, (pir_surface_ref){NULL, floor->field[i]}, pose, from[i], from[i] + 30);
    }
}

static void make_fold(sliding_floor *floor, bool ridge) {
    soup s = {0};
    double rise = 6 * FLOOR_SLOPE;
    for (int i = -30; i < 30; i += 2) {
        double a = i, b = i + 2;
        if (ridge) {
            // across the way: the line x = i + 2 is a ridge for every second strip
            bool up = i % 4 == 0 || i % 4 == -4;
            double low = up ? 0 : 2 * FLOOR_SLOPE, high = up ? 2 * FLOOR_SLOPE : 0;
            add_quad(&s, (pir_vec3){a, -6, low}, (pir_vec3){b, -6, high}, (pir_vec3){b, 6, high},
                     (pir_vec3){a, 6, low});
            continue;
        }
        add_quad(&s, (pir_vec3){a, -6, rise}, (pir_vec3){b, -6, rise}, (pir_vec3){b, 0, 0}, (pir_vec3){a, 0, 0});
        add_quad(&s, (pir_vec3){a, 0, 0}, (pir_vec3){b, 0, 0}, (pir_vec3){b, 6, rise}, (pir_vec3){a, 6, rise});
    }
    take_soup(floor, &s);
}

void floor_make(sliding_floor *floor, int kind) {
    static const char *const names[FLOOR_KINDS] = {
        "two triangles",    "prisms in one body",  "prisms apart", "T-junctions",
        "fields at a seam", "meshes that overlap", "ridges",       "valley"};
    soup s = {0};
    *floor = (sliding_floor){.name = names[kind]};
    switch (kind) {
    case 0:
        add_quad(&s, (pir_vec3){-30, -6, 0}, (pir_vec3){30, -6, 0}, (pir_vec3){30, 6, 0}, (pir_vec3){-30, 6, 0});
        take_soup(floor, &s);
        break;
    case 1:
    case 2:
        make_prisms(floor, kind == 2);
        break;
    case 3:
        make_junctions(floor);
        break;
    case 4:
        make_fields(floor);
        break;
    case 5:
        add_grid(&s, -30, 0.01, 1, 0);
        take_soup(floor, &s);
        add_grid(&s, 0, 30, 1, 0.3);
        take_soup(floor, &s);
        break;
    default:
        make_fold(floor, kind == FLOOR_RIDGE);
    }
}

void floor_clear(sliding_floor *floor) {
    for (uint32_t i = 0; i < floor->count; i++)
        pir_trimesh_release(floor->mesh[i]);
    for (int i = 0; i < 2; i++)
        pir_height_field_release(floor->field[i]);
    free(floor->mesh);
    free(floor->surface);
    free(floor->from);
    free(floor->to);
}

uint32_t floor_between(const sliding_floor *floor, double from, double to, pir_posed_surface *ret_surfaces,
                       uint32_t room) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < floor->count; i++)
        if (floor->from[i] <= to && floor->to[i] >= from && count < room)
            ret_surfaces[count++] = floor->surface[i];
    return count;
}

/* --- bodies --- */

/* Adds a piece; how far down the body reaches. */
static double add_piece(slider *body, const pir_vec3 *vertex, size_t count, double low) {
    if (pir_polytope_create(vertex, count, NULL, &body->piece[body->pieces++]) != PIR_OK)
        abort();
    for (size_t i = 0; i < count; i++)
        low = fmin(low, vertex[i].z);
    return low;
}

static double add_box(slider *body, pir_vec3 low, pir_vec3 high, double lowest) {
    pir_vec3 vertex[8];
    for (int i = 0; i < 8; i++)
        vertex[i] = (pir_vec3){i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z};
    return add_piece(body, vertex, 8, lowest);
}

/* Boxes side by side, with walls between them over the middle of the bottom and off it, and a keel within. */
static double add_compound(slider *body) {
    double low = add_box(body, (pir_vec3){-0.5, -0.4, -0.25}, (pir_vec3){0, 0.4, 0.25}, 0);
    low = add_box(body, (pir_vec3){0, -0.4, -0.25}, (pir_vec3){0.5, 0.125, 0.125}, low);
    low = add_box(body, (pir_vec3){0, 0.125, -0.25}, (pir_vec3){0.5, 0.4, 0.25}, low);
    const pir_vec3 keel[6] = {{-0.25, -0.25, -0.125}, {0.25, -0.25, -0.125}, {-0.25, 0.25, -0.125},
                              {0.25, 0.25, -0.125},   {-0.25, 0, -0.25},     {0.25, 0, -0.25}};
    return add_piece(body, keel, 6, low);
}

void slider_make(slider *body, int kind, double gap) {
    static const char *const names[SLIDER_KINDS] = {"box", "capsule", "hull of 20", "compound"};
    pir_vec3 vertex[20];
    double low = 0;
    test_random random = test_random_case("hull of 20", 1);
    *body = (struct slider){.name = names[kind], .pose = pir_pose_identity(), .inertia = 0.1};
    switch (kind) {
    case 0:
        low = add_box(body, (pir_vec3){-0.5, -0.4, -0.25}, (pir_vec3){0.5, 0.4, 0.25}, 0);
        break;
    case 1:
        for (int i = 0; i < 2; i++)
            vertex[i] = (pir_vec3){i ? 0.4 : -0.4, i ? 0.2 : -0.2, 0};
        low = add_piece(body, vertex, 2, 0);
        body->radius = 0.3;
        break;
    case 2:
        for (int i = 0; i < 20; i++) {
            pir_vec3 d = test_random_direction(&random);
            vertex[i] = (pir_vec3){0.5 * d.x, 0.5 * d.y, 0.4 * d.z};
        }
        low = add_piece(body, vertex, 20, 0);
        break;
    default:
        low = add_compound(body);
    }
    body->pose.translation.z = body->radius - low + gap;
}

void slider_clear(slider *body) {
    for (uint32_t i = 0; i < body->pieces; i++)
        pir_polytope_release(body->piece[i]);
}

static pir_vec3 sum(pir_vec3 a, double s, pir_vec3 b) {
    return (pir_vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static pir_vec3 cross(pir_vec3 a, pir_vec3 b) {
    return (pir_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(pir_vec3 a, pir_vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

void slider_step(slider *body, const pir_surface_contact *contacts, size_t count, double gap) {
    const double step = 1.0 / 60;
    double impulse[64] = {0};
    body->velocity.z -= 9.81 * step;
    for (int pass = 0; pass < 20; pass++)
        for (size_t i = 0; i < count && i < 64; i++) {
            const pir_surface_contact *c = &contacts[i];
            pir_vec3 at = sum(c->point_p, -1, body->pose.translation), turn = cross(at, c->normal);
            double may = c->distance > gap ? (c->distance - gap) / step : 0.2 * (c->distance - gap) / step;
            double speed = dot(c->normal, body->velocity) + dot(turn, body->spin);
            double mass = 1 / (1 + dot(turn, turn) / body->inertia), old = impulse[i];
            impulse[i] = fmax(old - mass * (speed + may), 0);
            body->velocity = sum(body->velocity, impulse[i] - old, c->normal);
            body->spin = sum(body->spin, (impulse[i] - old) / body->inertia, turn);
        }
    body->pose = pir_pose_integrate(body->pose, body->velocity, body->spin, step);
}
