/* SPDX-License-Identifier: MIT */
/* Memory of a unit, and its checks. */
#include "cspace/parts/unit.h"

#include "base/layout.h"

static pir_layout layout_of(pir_unit *unit) {
    return (pir_layout){{PIR_ROW(unit->count[0], unit->room), PIR_ROW(unit->count[1], unit->room),
                         PIR_ROW(unit->count[2], unit->room)}};
}

bool pir_unit_init(pir_unit *unit, uint32_t slices, const pir_allocator *allocator) {
    *unit = (pir_unit){.room = slices};
    pir_layout layout = layout_of(unit);
    if (pir_layout_new(allocator, &layout))
        return true;
    pir_unit_finish(unit, allocator);
    return false;
}

void pir_unit_finish(pir_unit *unit, const pir_allocator *allocator) {
    pir_layout layout = layout_of(unit);
    pir_layout_free(allocator, &layout);
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++) {
        pir_bytes_finish(&unit->data[s], allocator);
        pir_bytes_finish(&unit->packed[s], allocator);
    }
    *unit = (pir_unit){0};
}

void pir_unit_seal(pir_unit *unit) {
    for (int s = 0; s < PIR_UNIT_SECTION_COUNT; s++)
        unit->check[s] = pir_hash_words(PIR_HASH_START, unit->data[s].data, unit->data[s].used);
}
