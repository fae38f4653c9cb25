/* SPDX-License-Identifier: MIT */
/* Frames into a folder. */
#include "dump.h"

#include <inttypes.h>
#include <stdlib.h>

#include "message.h"
#include "target.h"

static bool make_exact_folder(const char *folder) {
    char *path = path_join(folder, EXACT_FOLDER);
    bool good = path && folder_make(path);
    free(path);
    return good;
}

bool dump_open(struct dump *dump, const char *folder, bool exact) {
    *dump = (struct dump){.folder = folder, .exact = exact};
    if (!folder_take(folder, &dump->lock) || (!exact && !make_exact_folder(folder)))
        return false;
    dump->index_path = path_join(folder, "frames.json");
    if (!dump->index_path || !output_open(&dump->index, dump->index_path))
        return false;
    dump->json = json_new();
    dump->frames = json_add_array(&dump->json, dump->json.root, "frames");
    return true;
}

static bool write_mesh(const struct dump *dump, const pir_mesh *mesh, const char *name, bool exact) {
    struct output_file file = {0};
    char *path = path_join(dump->folder, name);
    bool good = path && output_open(&file, path) && target_write_mesh(&file, mesh, exact);
    output_discard(&file);
    free(path);
    return good;
}

bool dump_frame(struct dump *dump, const pir_mesh *mesh, pir_quat rotation, uint64_t frame) {
    char doubles[48], exact[64];
    snprintf(doubles, sizeof doubles, "frame-%06" PRIu64 ".off", frame);
    snprintf(exact, sizeof exact, "%s%s", dump->exact ? "" : EXACT_FOLDER "/", doubles);
    if (!write_mesh(dump, mesh, exact, true) || (!dump->exact && !write_mesh(dump, mesh, doubles, false)))
        return false;
    cJSON *entry = json_add_object(&dump->json, dump->frames, NULL);
    json_add_count(&dump->json, entry, "index", frame);
    json_add_text(&dump->json, entry, "file", exact);
    if (!dump->exact)
        json_add_text(&dump->json, entry, "doubles", doubles);
    json_add_numbers(&dump->json, entry, "quat", (const double[]){rotation.x, rotation.y, rotation.z, rotation.w}, 4);
    return true;
}

bool dump_commit(struct dump *dump) {
    return json_print(&dump->json, dump->index.stream) && output_commit(&dump->index);
}

void dump_discard(struct dump *dump) {
    json_discard(&dump->json);
    output_discard(&dump->index);
    free(dump->index_path);
    folder_leave(dump->lock);
}
