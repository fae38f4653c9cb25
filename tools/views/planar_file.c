/* SPDX-License-Identifier: MIT */
/* The file is checked and copied, the copy gets the group, a seal and then the file's name. It is opened as one that
 * will be `name`: a run that is killed leaves a file that the next run on that name removes. */
#include "planar_file.h"

#include "../file.h"
#include "../message.h"
#include "columns.h"
#include "sink_file.h"

/* A group under way: how many corners each section has, and all corners. */
struct planar_group {
    struct sink_file file;
    hid_t group; /* 0 when closed */
    struct column count, corner;
};

/* Copies the file `path`, which is told as `name`, to an open stream. */
static bool copy_file(const char *path, const char *name, struct output_file *out) {
    static char block[1 << 16];
    FILE *from = fopen(path, "rb");
    if (!from) {
        complain("%s: cannot be read again", name);
        return false;
    }
    size_t size;
    bool done = true;
    while (done && (size = fread(block, 1, sizeof block, from)) > 0)
        done = fwrite(block, 1, size, out->stream) == size;
    if (ferror(from))
        complain("%s: cannot be read again", name);
    done = !ferror(from) && !output_failed(out);
    fclose(from);
    return done;
}

static bool group_open(struct planar_group *group, struct output_file *out, const struct planar *planar) {
    const bool open = sink_file_open(&group->file, out);
    const hid_t file = group->file.file;
    if (!open || (H5Lexists(file, "planar", H5P_DEFAULT) > 0 && H5Ldelete(file, "planar", H5P_DEFAULT) < 0))
        return false;
    group->group = group_make(file, "planar");
    const char axis[2] = {"xyz"[planar->axis], '\0'};
    return group->group && attribute_text(group->group, "axis", axis) &&
           attribute_number(group->group, "offset", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &planar->offset, 1) &&
           column_make(&group->count, group->group, "count", H5T_STD_U32LE, H5T_NATIVE_UINT32, 0) &&
           column_make(&group->corner, group->group, "corner", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 3);
}

static bool group_close(struct planar_group *group) {
    bool done = column_close(&group->count);
    done &= column_close(&group->corner);
    done &= group->group == 0 || H5Gclose(group->group) >= 0;
    return sink_file_close(&group->file) && done;
}

static bool put_section(struct planar_group *group, const pir_section *section) {
    uint32_t count = pir_section_corner_count(section);
    bool done = column_add(&group->count, &count);
    for (uint32_t i = 0; done && i < count; i++) {
        pir_vec3 c = pir_section_corners(section)[i];
        done = column_add(&group->corner, (const double[]){c.x, c.y, c.z});
    }
    return done;
}

/* All sections, pair by pair; false after a complaint or, with *ret_told false, when HDF5 failed. */
static bool put_sections(struct planar_group *group, const struct slices *slices, const struct planar *planar,
                         bool *ret_told) {
    for (uint32_t pair = 0; pair < slices->pairs; pair++)
        for (uint64_t s = 0; s < slices->count; s++) {
            pir_section *section = planar_section(planar, slices, s, pair);
            *ret_told = !section;
            bool done = section && put_section(group, section);
            pir_section_destroy(section);
            if (!done)
                return false;
        }
    return true;
}

/* Calls what checks or seals a file; false after a complaint. */
static bool ask_seal(pir_status (*ask)(const char *path, const pir_allocator *allocator, pir_report *report),
                     const char *path) {
    pir_report report;
    if (ask(path, NULL, &report) == PIR_OK)
        return true;
    complain("%s", report.text);
    return false;
}

bool planar_file_write(const char *path, const char *name, const struct planar *planar) {
    struct slices slices;
    struct output_file out = {0};
    struct planar_group group = {0};
    bool told = false;
    columns_quiet();
    if (!slices_open(&slices, path, 1, 1))
        return false;
    // HDF5 reads the copy as it is
    bool copied = ask_seal(pir_cspace_check, path) && output_open(&out, name) && output_lead_to(&out, path) &&
                  copy_file(path, name, &out);
    bool done = copied && group_open(&group, &out, planar) && put_sections(&group, &slices, planar, &told);
    done &= group_close(&group);
    const bool failed = copied && !told && output_failed(&out);
    if (copied && !done && !told && !failed)
        complain("%s: HDF5 cannot add the sections", name);
    done = done && !failed && ask_seal(pir_cspace_seal, out.temporary) && output_commit(&out);
    output_discard(&out);
    slices_close(&slices);
    return done;
}
