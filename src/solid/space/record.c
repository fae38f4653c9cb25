/* SPDX-License-Identifier: MIT */
/* See record.h. */
#include "solid/space/record.h"

#include <string.h>

void pir_number_list_add(pir_number_list *list, pir_space *space, uint32_t number) {
    if (pir_space_grow(space, (void **)&list->number, &list->room, list->count, sizeof *list->number))
        list->number[list->count++] = number;
}

void pir_record_finish(pir_side_record *record, pir_space *space) {
    pir_space_shrink(space, record->points.number, record->points.room, sizeof(uint32_t));
    pir_space_shrink(space, record->planes.number, record->planes.room, sizeof(uint32_t));
    pir_space_shrink(space, record->corners.number, record->corners.room, sizeof(uint32_t));
    pir_space_shrink(space, record->parted, record->parted_room, sizeof *record->parted);
    pir_space_shrink(space, record->met, record->met_room, sizeof *record->met);
    pir_space_shrink(space, record->told, record->told_room, sizeof *record->told);
    pir_space_shrink(space, record->slot, record->slot_room, sizeof *record->slot);
    *record = (pir_side_record){0};
}

static uint32_t slot_of(const pir_side_record *record, uint32_t plane, uint32_t point) {
    const uint64_t mixed = ((uint64_t)plane << 32 | point) * 0x9e3779b97f4a7c15u;
    return (uint32_t)(mixed >> 32) & (record->slot_room - 1);
}

/* The slot where a side is, or is to be. */
static uint32_t find_slot(const pir_side_record *record, uint32_t plane, uint32_t point) {
    uint32_t at = slot_of(record, plane, point);
    for (; record->slot[at] != 0; at = (at + 1) & (record->slot_room - 1)) {
        const pir_told_side *told = &record->told[record->slot[at] - 1];
        if (told->plane == plane && told->point == point)
            break;
    }
    return at;
}

/* Twice the slots, a power of two. */
static void widen(pir_side_record *record, pir_space *space) {
    const uint32_t room = record->slot_room ? 2 * record->slot_room : 256;
    uint32_t *slot = PIR_ZEROED(&space->allocator, uint32_t, room);
    if (!slot) {
        space->status = PIR_ERR_MEMORY;
        return;
    }
    pir_space_shrink(space, record->slot, record->slot_room, sizeof *record->slot);
    record->slot = slot;
    record->slot_room = room;
    for (uint32_t i = 0; i < record->told_count; i++)
        slot[find_slot(record, record->told[i].plane, record->told[i].point)] = i + 1;
}

void pir_record_begin(pir_side_record *record, pir_space *space) {
    if (record->told_count > record->slot_room / 8)
        memset(record->slot, 0, record->slot_room * sizeof *record->slot);
    else
        for (uint32_t i = record->told_count; i-- > 0;)
            record->slot[find_slot(record, record->told[i].plane, record->told[i].point)] = 0;
    record->points.count = record->planes.count = record->corners.count = 0;
    record->told_count = record->parted_count = record->met_count = 0;
    record->fleeting = false;
    space->record = record;
}

void pir_record_end(pir_space *space) {
    space->record = NULL;
}

void pir_record_point(pir_space *space, uint32_t point) {
    pir_number_list_add(&space->record->points, space, point);
}

void pir_record_plane(pir_space *space, uint32_t plane) {
    pir_number_list_add(&space->record->planes, space, plane);
}

void pir_record_side(pir_space *space, uint32_t plane, uint32_t point, int sign) {
    pir_side_record *record = space->record;
    if (sign == 0 || space->status != PIR_OK)
        return;
    if (2 * (record->told_count + 1) > record->slot_room)
        widen(record, space);
    if (!pir_space_grow(space, (void **)&record->told, &record->told_room, record->told_count, sizeof *record->told))
        return;
    const uint32_t slot = find_slot(record, plane, point);
    if (record->slot[slot] != 0)
        return;
    record->told[record->told_count] = (pir_told_side){plane, point, sign};
    record->slot[slot] = ++record->told_count;
}

void pir_record_polygon(const pir_polygons *polygons, uint32_t polygon, uint32_t half, int side) {
    const pir_polygon p = polygons->polygon[polygon];
    for (uint32_t i = 0; i < p.count; i++)
        pir_record_side(polygons->space, half >> 1, polygons->point[p.first + i], half & 1 ? -side : side);
}

static void add_corners(const pir_polygons *polygons, pir_polygon p) {
    for (uint32_t i = 0; i < p.count; i++)
        pir_number_list_add(&polygons->space->record->corners, polygons->space, polygons->point[p.first + i]);
}

void pir_record_parted(const pir_polygons *polygons, uint32_t polygon, uint32_t half) {
    pir_side_record *record = polygons->space->record;
    const pir_polygon p = polygons->polygon[polygon];
    if (!pir_space_grow(polygons->space, (void **)&record->parted, &record->parted_room, record->parted_count,
                        sizeof *record->parted))
        return;
    record->parted[record->parted_count++] =
        (pir_parted_polygon){.set = record->set, .plane = half >> 1, .first = record->corners.count, .count = p.count};
    add_corners(polygons, p);
}

void pir_record_met(const pir_polygons *polygons, uint32_t polygon, uint32_t set) {
    pir_side_record *record = polygons->space->record;
    const pir_polygon p = polygons->polygon[polygon];
    if (!pir_space_grow(polygons->space, (void **)&record->met, &record->met_room, record->met_count,
                        sizeof *record->met))
        return;
    record->met[record->met_count++] = (pir_met){set, record->corners.count, p.count};
    add_corners(polygons, p);
}
