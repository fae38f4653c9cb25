/* SPDX-License-Identifier: MIT */
/* The store of a build without HDF5: no file can be made or opened, so there is nothing to read from one. */
#include "base/report.h"
#include "cspace/parts/pack.h"
#include "cspace/store/assemble.h"
#include "cspace/store/store.h"

pir_packer *pir_packer_new(const pir_allocator *allocator) {
    pir_packer *packer = PIR_NEW(allocator, pir_packer, 1);
    if (packer)
        packer->allocator = *allocator;
    return packer;
}

void pir_packer_free(pir_packer *packer) {
    if (!packer)
        return;
    const pir_allocator a = packer->allocator;
    PIR_FREE(&a, packer, 1);
}

bool pir_unit_pack(pir_unit *unit, pir_packer *packer, const pir_allocator *allocator) {
    (void)unit;
    (void)packer;
    (void)allocator;
    return true;
}

pir_status pir_assemble(const pir_parts *parts, const pir_cspace_options *options, pir_report *report) {
    (void)options;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "%s: this build has no HDF5", parts->file);
}

bool pir_assembled(const pir_parts *parts) {
    (void)parts;
    return false;
}

pir_status pir_store_open(const char *path, const pir_allocator *allocator, pir_report *report, pir_store **ret_store) {
    (void)allocator;
    (void)ret_store;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "%s: this build has no HDF5", path);
}

void pir_store_close(pir_store *store) {
    (void)store;
}

const pir_cspace_info *pir_store_info(const pir_store *store) {
    (void)store;
    return NULL;
}

pir_polytope *const *pir_store_pieces(const pir_store *store) {
    (void)store;
    return NULL;
}

pir_status pir_store_rotations(pir_store *store, uint64_t first, size_t count, pir_report *report,
                               pir_quat *ret_rotations) {
    (void)store;
    (void)first;
    (void)count;
    (void)ret_rotations;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "this build has no HDF5");
}

pir_status pir_store_unit(pir_store *store, pir_unit_section section, uint64_t number, pir_report *report,
                          pir_unit *unit) {
    (void)store;
    (void)section;
    (void)number;
    (void)unit;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "this build has no HDF5");
}

pir_status pir_cspace_check(const char *path, const pir_allocator *allocator, pir_report *report) {
    (void)path;
    (void)allocator;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "this build has no HDF5");
}

pir_status pir_cspace_seal(const char *path, const pir_allocator *allocator, pir_report *report) {
    (void)path;
    (void)allocator;
    return pir_fail(report, PIR_ERR_NOT_BUILT, "this build has no HDF5");
}
