/* SPDX-License-Identifier: MIT */
/*
 * A VTKHDF file of type UnstructuredGrid. Each slice is one partition, whose cells are the facets of all its
 * differences as polygons; of each cell it holds the pair of pieces and the kind, and of a slice its number as the time
 * of a step. VTK 9.1 knows no steps, and reads partition k as piece k of as many as there are slices.
 *
 * Points of a pair stand once a slice, for all facets that meet there.
 */
#include "vtk.h"

#include <stdlib.h>

#include "../file.h"
#include "../message.h"
#include "columns.h"
#include "sink_file.h"

#define VTK_POLYGON 7

/* The datasets that grow with the cells. */
enum { POINTS, CONNECTIVITY, OFFSETS, TYPES, ROBOT, OBSTACLE, KIND, CELL_DATASETS };
/* The datasets with a number for each slice. */
enum {
    POINT_COUNT,
    CELL_COUNT,
    CONNECTIVITY_COUNT,
    VALUES,
    PARTS,
    PART,
    POINT_START,
    CELL_START,
    CONNECTIVITY_START,
    ROBOT_START,
    OBSTACLE_START,
    KIND_START,
    STEP_DATASETS
};

struct vtk_file {
    struct sink_file file;
    hid_t root, cells, steps, offsets; /* groups; 0 when closed */
    struct column cell[CELL_DATASETS], step[STEP_DATASETS];
};

static bool open_groups(struct vtk_file *vtk, struct output_file *out, const struct slices *slices) {
    const int64_t version[2] = {1, 0}, count = (int64_t)slices->count;
    vtk->root = sink_file_make(&vtk->file, out) ? group_make(vtk->file.file, "VTKHDF") : 0;
    vtk->cells = vtk->root ? group_make(vtk->root, "CellData") : 0;
    vtk->steps = vtk->root ? group_make(vtk->root, "Steps") : 0;
    vtk->offsets = vtk->steps ? group_make(vtk->steps, "CellDataOffsets") : 0;
    return vtk->cells && vtk->offsets &&
           attribute_number(vtk->root, "Version", H5T_STD_I64LE, H5T_NATIVE_INT64, version, 2) &&
           attribute_text(vtk->root, "Type", "UnstructuredGrid") &&
           attribute_number(vtk->steps, "NSteps", H5T_STD_I64LE, H5T_NATIVE_INT64, &count, 1);
}

static bool open_columns(struct vtk_file *vtk) {
    const hid_t i64 = H5T_STD_I64LE, n64 = H5T_NATIVE_INT64, f64 = H5T_IEEE_F64LE, d = H5T_NATIVE_DOUBLE;
    const struct {
        hid_t parent;
        const char *name;
    } steps[STEP_DATASETS] = {
        [POINT_COUNT] = {vtk->root, "NumberOfPoints"},
        [CELL_COUNT] = {vtk->root, "NumberOfCells"},
        [CONNECTIVITY_COUNT] = {vtk->root, "NumberOfConnectivityIds"},
        [VALUES] = {vtk->steps, "Values"},
        [PARTS] = {vtk->steps, "NumberOfParts"},
        [PART] = {vtk->steps, "PartOffsets"},
        [POINT_START] = {vtk->steps, "PointOffsets"},
        [CELL_START] = {vtk->steps, "CellOffsets"},
        [CONNECTIVITY_START] = {vtk->steps, "ConnectivityIdOffsets"},
        [ROBOT_START] = {vtk->offsets, "robot"},
        [OBSTACLE_START] = {vtk->offsets, "obstacle"},
        [KIND_START] = {vtk->offsets, "kind"},
    };
    static const char *const numbers[] = {"robot", "obstacle", "kind"};
    bool done = column_make(&vtk->cell[POINTS], vtk->root, "Points", f64, d, 3) &&
                column_make(&vtk->cell[CONNECTIVITY], vtk->root, "Connectivity", i64, n64, 0) &&
                column_make(&vtk->cell[OFFSETS], vtk->root, "Offsets", i64, n64, 0) &&
                column_make(&vtk->cell[TYPES], vtk->root, "Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, 0);
    for (int i = 0; done && i < 3; i++)
        done = column_make(&vtk->cell[ROBOT + i], vtk->cells, numbers[i], H5T_STD_I32LE, n64, 0);
    for (int i = 0; done && i < STEP_DATASETS; i++) {
        // of cells and connectivity ids, one topology
        hsize_t width = i == CELL_START || i == CONNECTIVITY_START ? 1 : 0;
        done = column_make(&vtk->step[i], steps[i].parent, steps[i].name, i == VALUES ? f64 : i64, n64, width);
    }
    return done;
}

static bool close_all(struct vtk_file *vtk) {
    bool done = true;
    for (int i = 0; i < CELL_DATASETS; i++)
        done &= column_close(&vtk->cell[i]);
    for (int i = 0; i < STEP_DATASETS; i++)
        done &= column_close(&vtk->step[i]);
    const hid_t groups[] = {vtk->offsets, vtk->steps, vtk->cells, vtk->root};
    for (int i = 0; i < 4; i++)
        done &= groups[i] == 0 || H5Gclose(groups[i]) >= 0;
    return sink_file_close(&vtk->file) && done;
}

/* One facet; its corners count from `first` on. */
static bool put_facet(struct vtk_file *vtk, const pir_mesh *mesh, uint32_t facet, int64_t first, int64_t *ids) {
    uint32_t count;
    const uint32_t *corner = pir_mesh_facet(mesh, facet, &count);
    const uint8_t type = VTK_POLYGON;
    bool done = true;
    for (uint32_t i = 0; done && i < count; i++) {
        int64_t id = first + corner[i];
        done = column_add(&vtk->cell[CONNECTIVITY], &id);
    }
    *ids += count;
    const int64_t kind = (int64_t)pir_mesh_facet_kind(mesh, facet);
    return done && column_add(&vtk->cell[OFFSETS], ids) && column_add(&vtk->cell[TYPES], &type) &&
           column_add(&vtk->cell[KIND], &kind);
}

/* One difference of a slice; false when HDF5 failed. */
static bool put_mesh(struct vtk_file *vtk, const struct slices *slices, const pir_mesh *mesh, uint32_t pair,
                     int64_t counts[3]) {
    const pir_vec3 *vertices = pir_mesh_vertices(mesh);
    const int64_t robot = pair / slices->info.obstacle_count, obstacle = pair % slices->info.obstacle_count;
    uint32_t points = pir_mesh_vertex_count(mesh), facets = pir_mesh_facet_count(mesh);
    bool done = true;
    for (uint32_t v = 0; done && v < points; v++)
        done = column_add(&vtk->cell[POINTS], (const double[]){vertices[v].x, vertices[v].y, vertices[v].z});
    for (uint32_t f = 0; done && f < facets; f++)
        done = put_facet(vtk, mesh, f, counts[0], &counts[2]) && column_add(&vtk->cell[ROBOT], &robot) &&
               column_add(&vtk->cell[OBSTACLE], &obstacle);
    counts[0] += points;
    counts[1] += facets;
    return done;
}

/* One slice; false after a complaint or, with *ret_told false, when HDF5 failed. */
static bool put_slice(struct vtk_file *vtk, const struct slices *slices, uint64_t shown, bool *ret_told) {
    const int64_t cells = (int64_t)vtk->cell[TYPES].rows, zero = 0;
    int64_t step[STEP_DATASETS] = {
        [VALUES] = (int64_t)slices_number(slices, shown),
        [PARTS] = 1,
        [PART] = (int64_t)shown,
        [POINT_START] = (int64_t)vtk->cell[POINTS].rows,
        [CELL_START] = cells,
        [CONNECTIVITY_START] = (int64_t)vtk->cell[CONNECTIVITY].rows,
        [ROBOT_START] = cells,
        [OBSTACLE_START] = cells,
        [KIND_START] = cells,
    };
    // the offsets of a slice begin with 0
    bool done = column_add(&vtk->cell[OFFSETS], &zero);
    for (uint32_t pair = 0; done && pair < slices->pairs; pair++) {
        pir_mesh *mesh = slices_mesh(slices, shown, pair, PIR_DOUBLE);
        *ret_told = !mesh;
        done = mesh && put_mesh(vtk, slices, mesh, pair, &step[POINT_COUNT]);
        pir_mesh_destroy(mesh);
    }
    for (int i = 0; done && i < STEP_DATASETS; i++)
        done = column_add(&vtk->step[i], &step[i]);
    return done;
}

bool vtk_write(const char *path, const struct slices *slices) {
    struct output_file out = {0};
    if (output_is_stream(path)) {
        complain("%s: a file of VTK goes to a regular file, not to a stream", path);
        return false;
    }
    if (!output_open(&out, path))
        return false;
    struct vtk_file vtk = {0};
    bool told = false;
    columns_quiet();
    bool done = open_groups(&vtk, &out, slices) && open_columns(&vtk);
    for (uint64_t s = 0; done && s < slices->count; s++)
        done = put_slice(&vtk, slices, s, &told);
    done &= close_all(&vtk);
    if (!done && !told && !output_failed(&out))
        complain("%s: HDF5 cannot write the file", path);
    done = done && output_commit(&out);
    output_discard(&out);
    return done;
}
