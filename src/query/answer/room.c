/* SPDX-License-Identifier: MIT */
/* The queries' room in a thread's scratch: see room.h. */
#include "query/answer/room.h"

static void destroy(void *at, const pir_allocator *allocator) {
    pir_query_room *room = at;
    pir_planes_finish(&room->planes, allocator);
    pir_group_work_finish(&room->work, allocator);
    PIR_FREE(allocator, room->limbs.base, room->limbs.capacity);
    pir_patch_room_finish(&room->patches, allocator);
    PIR_FREE(allocator, room, 1);
}

pir_query_room *pir_query_room_of(pir_scratch *scratch) {
    return pir_scratch_room(scratch, PIR_ROOM_QUERY, sizeof(pir_query_room), destroy);
}

pir_status pir_query_room_reserve_limbs(pir_query_room *room, const pir_scratch *scratch, const pir_polytope *p,
                                        const pir_polytope *q) {
    uint32_t need = pir_exact_limbs(p, q);
    if (need <= room->limbs.capacity)
        return PIR_OK;
    mp_limb_t *limbs = PIR_NEW(&scratch->allocator, mp_limb_t, need);
    if (!limbs)
        return PIR_ERR_MEMORY;
    PIR_FREE(&scratch->allocator, room->limbs.base, room->limbs.capacity);
    room->limbs = (pir_limbs){limbs, 0, need};
    room->owner = NULL;
    return PIR_OK;
}
