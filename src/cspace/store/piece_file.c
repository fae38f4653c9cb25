/* SPDX-License-Identifier: MIT */
/* Pieces written. A segment has the facets and edges here that the pairing has of it. */
#include "cspace/store/piece_file.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "base/layout.h"
#include "polytope/polytope.h"

/* How many pieces before one are compared with it. */
#define NEAR 256u

/* The arrays of a piece, as they are written. */
struct arrays {
    double (*vertex)[3], (*normal)[3];
    uint32_t (*edge)[2], (*edge_facet)[2], *facet_start, *facet_vertex;
};

static pir_layout layout_of(struct arrays *arrays, const pir_polytope *p) {
    return (pir_layout){{PIR_ROW(arrays->vertex, p->vertex_count), PIR_ROW(arrays->normal, p->facet_count),
                         PIR_ROW(arrays->edge, p->edge_count), PIR_ROW(arrays->edge_facet, p->edge_count),
                         PIR_ROW(arrays->facet_start, (size_t)p->facet_count + 1),
                         PIR_ROW(arrays->facet_vertex, p->half_count)}};
}

static void put_vec(double *at, pir_vec3 v) {
    at[0] = v.x;
    at[1] = v.y;
    at[2] = v.z;
}

static void fill(struct arrays *arrays, const pir_polytope *p) {
    for (uint32_t v = 0; v < p->vertex_count; v++)
        put_vec(arrays->vertex[v], p->vertex[v]);
    for (uint32_t e = 0; e < p->edge_count; e++) {
        uint32_t h = p->edge_half[e];
        arrays->edge[e][0] = p->origin[h];
        arrays->edge[e][1] = p->target[h];
        arrays->edge_facet[e][0] = p->left[h];
        arrays->edge_facet[e][1] = pir_right(p, h);
    }
    uint32_t corners = 0;
    for (uint32_t f = 0; f < p->facet_count; f++) {
        put_vec(arrays->normal[f], p->normal[f]);
        arrays->facet_start[f] = corners;
        for (uint32_t i = p->loop_start[f]; i < p->loop_start[f + 1]; i++)
            arrays->facet_vertex[corners++] = p->origin[p->loop[i]];
        arrays->facet_start[f + 1] = corners;
    }
}

/* Where arrays go. */
struct array_place {
    hid_t group;
    pir_packer *packer;
};

/* Digits of doubles are as good as random: they are kept as they are. */
static bool put_rows(const struct array_place *at, const char *name, pir_h5_type type, uint64_t rows, uint64_t columns,
                     const void *data) {
    const uint64_t number = type == PIR_H5_U8 ? 1 : type == PIR_H5_U32 ? 4 : 8;
    const uint64_t chunk = PIR_CHUNK_MOST / (number * (columns ? columns : 1));
    const pir_h5_shape shape = {type, columns ? 2 : 1, {rows, columns}, {chunk, columns}, false, type == PIR_H5_F64};
    return pir_h5_put(at->group, name, &shape, data, at->packer);
}

static bool put_arrays(const struct array_place *at, const struct arrays *arrays, const pir_polytope *p) {
    return put_rows(at, "vertex", PIR_H5_F64, p->vertex_count, 3, arrays->vertex) &&
           put_rows(at, "normal", PIR_H5_F64, p->facet_count, 3, arrays->normal) &&
           put_rows(at, "edge", PIR_H5_U32, p->edge_count, 2, arrays->edge) &&
           put_rows(at, "edge_facet", PIR_H5_U32, p->edge_count, 2, arrays->edge_facet) &&
           put_rows(at, "facet_start", PIR_H5_U32, (uint64_t)p->facet_count + 1, 0, arrays->facet_start) &&
           put_rows(at, "facet_vertex", PIR_H5_U32, p->facet_count ? p->half_count : 0, 0, arrays->facet_vertex);
}

/* Where a piece of the plan stands, by its number among all. */
static void write_path(const pir_plan *plan, uint32_t number, char path[32]) {
    bool of_robot = number < plan->robot_count;
    snprintf(path, 32, "/%s/%" PRIu32, of_robot ? "robot" : "obstacle", of_robot ? number : number - plan->robot_count);
}

/* The piece shortly before that is the same, or `number`. */
static uint32_t find_same(const pir_plan_piece *piece, uint32_t number) {
    const pir_plan_piece *own = &piece[number];
    for (uint32_t i = number > NEAR ? number - NEAR : 0; i < number; i++)
        if (piece[i].hash == own->hash && piece[i].off.used == own->off.used &&
            memcmp(piece[i].off.data, own->off.data, own->off.used) == 0)
            return i;
    return number;
}

static bool put_piece(hid_t file, const char *path, const pir_plan_piece *piece, pir_packer *packer,
                      const pir_allocator *a) {
    char hash[17];
    const pir_polytope *p = piece->polytope;
    struct arrays arrays = {0};
    pir_layout layout = layout_of(&arrays, p);
    snprintf(hash, sizeof hash, "%016" PRIx64, piece->hash);
    hid_t group = pir_h5_make_group(file, path);
    const struct array_place at = {group, packer};
    bool good = group >= 0 && pir_layout_new(a, &layout) && pir_h5_put_text(group, "hash", hash) &&
                put_rows(&at, "off", PIR_H5_U8, piece->off.used, 0, piece->off.data);
    if (good) {
        fill(&arrays, p);
        good = put_arrays(&at, &arrays, p);
    }
    pir_layout_free(a, &layout);
    return pir_h5_close(group) && good;
}

bool pir_pieces_put(hid_t file, const pir_plan *plan, pir_packer *packer) {
    hid_t robot = pir_h5_make_group(file, "robot"), obstacle = pir_h5_make_group(file, "obstacle");
    bool good = robot >= 0 && obstacle >= 0;
    for (uint32_t i = 0; good && i < plan->robot_count + plan->obstacle_count; i++) {
        char path[32], same[32];
        uint32_t before = find_same(plan->piece, i);
        write_path(plan, i, path);
        write_path(plan, before, same);
        if (before < i)
            good = H5Lcreate_hard(file, same, file, path, H5P_DEFAULT, H5P_DEFAULT) >= 0;
        else
            good = put_piece(file, path, &plan->piece[i], packer, &plan->allocator);
    }
    good = pir_h5_close(robot) && good;
    return pir_h5_close(obstacle) && good;
}
