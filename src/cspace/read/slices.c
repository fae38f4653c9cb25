/* SPDX-License-Identifier: MIT */
/* Files of slices opened, and the pairs of a slice; see cspace.h. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/report.h"
#include "cspace/read/cspace.h"

/* --- opening --- */

/* How many rotations of a list are read at a time. */
#define BLOCK 4096

/* Reads all rotations. Memory grows with what has been read, whatever number of them the file claims. */
static pir_status read_list(pir_cspace *cspace, pir_report *report, pir_quat **rotation, size_t *room) {
    const size_t count = (size_t)cspace->info.grid.count;
    for (size_t done = 0; done < count;) {
        size_t more = count - done < BLOCK ? count - done : BLOCK;
        if (done + more > *room) {
            size_t wanted = 2 * *room > done + more ? 2 * *room : done + more;
            pir_quat *grown = PIR_RESIZE(&cspace->allocator, *rotation, *room, wanted);
            if (!grown)
                return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
            *rotation = grown;
            *room = wanted;
        }
        pir_status status = pir_store_rotations(cspace->store, done, more, report, *rotation + done);
        if (status != PIR_OK)
            return status;
        done += more;
    }
    return PIR_OK;
}

/* The grid of a list. */
static pir_status make_list(pir_cspace *cspace, pir_report *report) {
    if (cspace->info.grid.count > PIR_GRID_LIST_MAX)
        return pir_fail(report, PIR_ERR_LIMIT, "slices: grid: more rotations than a list may have");
    pir_quat *rotation = NULL;
    size_t room = 0, count = (size_t)cspace->info.grid.count;
    pir_status status = read_list(cspace, report, &rotation, &room);
    if (status == PIR_OK) {
        status = pir_grid_list(rotation, count, 1, &cspace->allocator, &cspace->grid);
        if (status != PIR_OK)
            pir_fail(report, status, "slices: grid: %s", pir_status_text(status));
    }
    PIR_FREE(&cspace->allocator, rotation, room);
    return status;
}

static pir_status make_grid(pir_cspace *cspace, pir_report *report) {
    const pir_grid_info *grid = &cspace->info.grid;
    pir_status status = PIR_ERR_FORMAT;
    if (grid->kind == PIR_GRID_LIST)
        return make_list(cspace, report);
    if (grid->kind == PIR_GRID_AXIS)
        status = pir_grid_axis(grid->axis, grid->count, &cspace->allocator, &cspace->grid);
    else if (grid->level <= PIR_GRID_LEVEL_MAX && grid->count == (uint64_t)72 << 3 * grid->level)
        status = pir_grid_hopf(grid->level, &cspace->allocator, &cspace->grid);
    if (status != PIR_OK && status != PIR_ERR_MEMORY)
        status = PIR_ERR_FORMAT;
    return status == PIR_OK ? PIR_OK : pir_fail(report, status, "slices: grid: its attributes make no such grid");
}

static pir_status begin(pir_cspace *cspace, pir_report *report) {
    cspace->info = *pir_store_info(cspace->store);
    pir_status status = make_grid(cspace, report);
    if (status != PIR_OK)
        return status;
    cspace->info.grid = pir_grid_get_info(cspace->grid);
    cspace->units_per_pair = (cspace->info.grid.count - 1) / cspace->info.slices_per_unit + 1;
    return PIR_OK;
}

static void forget_pair(pir_cspace *cspace) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    pir_record_replay_finish(&cursor->replay);
    pir_polytope_release(cursor->minus_p);
    cursor->minus_p = NULL;
    cursor->has_replay = cursor->has_slice = false;
}

void pir_cspace_destroy(pir_cspace *cspace) {
    if (!cspace)
        return;
    const pir_allocator a = cspace->allocator;
    pir_cspace_cursor *cursor = &cspace->cursor;
    if (cspace->answers_free)
        cspace->answers_free(cspace);
    forget_pair(cspace);
    for (int i = 0; i < PIR_UNITS_KEPT; i++) {
        PIR_FREE(&a, cursor->kept[i].rotation, cursor->kept[i].unit.room);
        pir_unit_finish(&cursor->kept[i].unit, &a);
    }
    PIR_FREE(&a, cursor->ee, cursor->ee_room);
    PIR_FREE(&a, cursor->plane, cursor->plane_room);
    pir_grid_destroy(cspace->grid);
    pir_store_close(cspace->store);
    PIR_FREE(&a, cspace, 1);
}

pir_status pir_cspace_open(const char *path, const pir_allocator *allocator, pir_report *report,
                           pir_cspace **ret_cspace) {
    if (!path || !ret_cspace)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put it");
    const pir_allocator a = pir_allocator_or_default(allocator);
    pir_cspace *cspace = PIR_ZEROED(&a, pir_cspace, 1);
    if (!cspace)
        return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    cspace->allocator = a;
    pir_status status = pir_store_open(path, &a, report, &cspace->store);
    if (status == PIR_OK)
        status = begin(cspace, report);
    if (status != PIR_OK) {
        pir_cspace_destroy(cspace);
        return status;
    }
    *ret_cspace = cspace;
    return PIR_OK;
}

/* --- what it holds --- */

pir_cspace_info pir_cspace_get_info(const pir_cspace *cspace) {
    return cspace->info;
}

const pir_grid *pir_cspace_grid(const pir_cspace *cspace) {
    return cspace->grid;
}

const pir_polytope *pir_cspace_robot(const pir_cspace *cspace, uint32_t piece) {
    return pir_store_pieces(cspace->store)[piece];
}

const pir_polytope *pir_cspace_obstacle(const pir_cspace *cspace, uint32_t piece) {
    return pir_store_pieces(cspace->store)[cspace->info.robot_count + piece];
}

/* --- the cursor --- */

/* The rotations of the unit; each must be the grid's own, bit for bit. */
static pir_status read_rotations(pir_cspace *cspace, pir_quat *rotation, uint64_t first, uint32_t count,
                                 pir_report *report) {
    pir_status status = pir_store_rotations(cspace->store, first, count, report, rotation);
    for (uint32_t i = 0; status == PIR_OK && i < count; i++) {
        pir_quat q = pir_grid_rotation(cspace->grid, first + i);
        if (memcmp(&q, &rotation[i], sizeof q) != 0)
            status = pir_fail(report, PIR_ERR_FORMAT, "slices: grid/rotation: row %" PRIu64 ": it is not the grid's",
                              first + i);
    }
    return status;
}

/* Room for the slices of a unit, made when it is first needed. */
static bool reserve_unit(const pir_cspace *cspace, pir_cspace_unit *kept) {
    const pir_cspace_info *info = &cspace->info;
    uint32_t slices = info->slices_per_unit < info->grid.count ? info->slices_per_unit : (uint32_t)info->grid.count;
    if (kept->rotation)
        return true;
    if (!kept->unit.room && !pir_unit_init(&kept->unit, slices, &cspace->allocator))
        return false;
    kept->rotation = PIR_NEW(&cspace->allocator, pir_quat, slices);
    return kept->rotation != NULL;
}

/* The unit where it is kept, else the place of the one that was not asked for longest. */
static pir_cspace_unit *find_unit(pir_cspace_cursor *cursor, uint64_t number) {
    pir_cspace_unit *oldest = cursor->kept;
    for (pir_cspace_unit *kept = cursor->kept; kept < cursor->kept + PIR_UNITS_KEPT; kept++) {
        if (kept->asked && kept->unit.number == number)
            return kept;
        if (kept->asked < oldest->asked)
            oldest = kept;
    }
    oldest->asked = 0;
    return oldest;
}

static pir_status go_to_unit(pir_cspace *cspace, uint64_t number, pir_report *report) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    if (cursor->at && cursor->at->unit.number == number)
        return PIR_OK;
    cursor->has_slice = false;
    cursor->at = NULL;
    pir_cspace_unit *kept = find_unit(cursor, number);
    if (!kept->asked) {
        if (!reserve_unit(cspace, kept))
            return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
        pir_status status = pir_store_unit(cspace->store, PIR_UNIT_SECTION_RECORDS, number, report, &kept->unit);
        if (status == PIR_OK)
            status =
                read_rotations(cspace, kept->rotation, number % cspace->units_per_pair * cspace->info.slices_per_unit,
                               kept->unit.slices, report);
        if (status != PIR_OK)
            return status;
    }
    kept->asked = ++cursor->asks;
    cursor->at = kept;
    return PIR_OK;
}

static pir_status go_to_pair(pir_cspace *cspace, pir_cspace_place place, uint64_t pair, pir_report *report) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    if (cursor->has_replay && cursor->pair == pair)
        return PIR_OK;
    forget_pair(cspace);
    pir_status status = pir_polytope_reflect(pir_cspace_robot(cspace, place.robot), &cursor->minus_p);
    if (status == PIR_OK && !pir_record_replay_init(&cursor->replay, cursor->minus_p,
                                                    pir_cspace_obstacle(cspace, place.obstacle), &cspace->allocator))
        status = PIR_ERR_MEMORY;
    if (status != PIR_OK) {
        forget_pair(cspace);
        return pir_fail(report, status, "slices: %s", pir_status_text(status));
    }
    cursor->has_replay = true;
    cursor->pair = pair;
    return PIR_OK;
}

/* Applies records up to that of slice `to` of the unit: from where the replay is, or from the key slice before. */
static pir_status go_to_slice(pir_cspace *cspace, uint32_t to, pir_report *report) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    const pir_unit *unit = &cursor->at->unit;
    const uint32_t *length = unit->count[PIR_UNIT_SECTION_RECORDS];
    uint32_t key = to - to % cspace->info.slices_per_key, at = cursor->slice + 1;
    if (cursor->has_slice && cursor->slice == to)
        return PIR_OK;
    if (!cursor->has_slice || cursor->slice > to || cursor->slice + 1 < key) {
        cursor->offset = 0;
        for (at = 0; at < key; at++)
            cursor->offset += length[at];
    }
    cursor->has_slice = false;
    for (; at <= to; at++) {
        pir_status status = pir_record_replay_record(
            &cursor->replay, unit->data[PIR_UNIT_SECTION_RECORDS].data + cursor->offset, length[at]);
        if (status != PIR_OK)
            return pir_fail(report, status, "slices: unit %" PRIu64 ": record %u: %s", cursor->at->unit.number,
                            (unsigned)at, pir_status_text(status));
        cursor->offset += length[at];
    }
    cursor->slice = to;
    cursor->has_slice = true;
    return PIR_OK;
}

static pir_status go_to(pir_cspace *cspace, pir_cspace_place place, pir_report *report) {
    const pir_cspace_info *info = &cspace->info;
    if (place.robot >= info->robot_count || place.obstacle >= info->obstacle_count || place.slice >= info->grid.count)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: there is no slice %" PRIu64 " of pair (%u, %u)", place.slice,
                        (unsigned)place.robot, (unsigned)place.obstacle);
    uint64_t pair = (uint64_t)place.robot * info->obstacle_count + place.obstacle;
    uint64_t unit = pair * cspace->units_per_pair + place.slice / info->slices_per_unit;
    pir_status status = go_to_unit(cspace, unit, report);
    if (status == PIR_OK)
        status = go_to_pair(cspace, place, pair, report);
    return status == PIR_OK ? go_to_slice(cspace, (uint32_t)(place.slice % info->slices_per_unit), report) : status;
}

/* --- pairs --- */

pir_status pir_cspace_go_to(pir_cspace *cspace, pir_cspace_place place, pir_report *report,
                            const pir_record_replay_crossing **ret_crossings, uint32_t *ret_count) {
    const pir_cspace_cursor *cursor = &cspace->cursor;
    pir_status status = go_to(cspace, place, report);
    if (status != PIR_OK)
        return status;
    status = pir_record_replay_crossings(&cspace->cursor.replay, ret_crossings, ret_count);
    if (status == PIR_OK)
        return PIR_OK;
    return pir_fail(report, status, "slices: unit %" PRIu64 ": record %u: %s", cursor->at->unit.number,
                    (unsigned)cursor->slice, pir_status_text(status));
}

/* Room for the pairs that are shown. */
static bool reserve_ee(pir_cspace *cspace, uint32_t count) {
    pir_cspace_cursor *cursor = &cspace->cursor;
    if (cursor->ee && count <= cursor->ee_room)
        return true;
    uint32_t(*room)[2] = pir_memory_new(&cspace->allocator, count, sizeof *room);
    if (!room)
        return false;
    PIR_FREE(&cspace->allocator, cursor->ee, cursor->ee_room);
    cursor->ee = room;
    cursor->ee_room = count;
    return true;
}

pir_status pir_cspace_slice(pir_cspace *cspace, pir_cspace_place place, pir_report *report, pir_slice *ret_slice) {
    if (!cspace || !ret_slice)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file, or nowhere to put the slice");
    const pir_record_replay_crossing *crossing;
    uint32_t count;
    pir_status status = pir_cspace_go_to(cspace, place, report, &crossing, &count);
    if (status != PIR_OK)
        return status;
    if (!reserve_ee(cspace, count))
        return pir_fail(report, PIR_ERR_MEMORY, "slices: out of memory");
    const pir_record_replay *replay = &cspace->cursor.replay;
    for (uint32_t i = 0; i < count; i++) {
        cspace->cursor.ee[i][0] = replay->p->artificial ? 0 : crossing[i].edge;
        cspace->cursor.ee[i][1] = replay->q->artificial ? 0 : replay->q->edge[crossing[i].half];
    }
    *ret_slice = (pir_slice){.rotation = pir_cspace_cursor_rotation(cspace),
                             .fv_count = pir_polytope_facet_count(replay->p),
                             .vf_count = pir_polytope_facet_count(replay->q),
                             .ee_count = count,
                             .fv = replay->fv,
                             .vf = replay->vf,
                             .ee = (const uint32_t(*)[2])cspace->cursor.ee};
    return PIR_OK;
}
