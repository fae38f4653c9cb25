/* SPDX-License-Identifier: MIT */
/* Frames into a folder. */
#include "dump.h"

#include <inttypes.h>
#include <stdlib.h>

#include "message.h"

bool dump_open(struct dump *dump, const char *folder) {
    *dump = (struct dump){.folder = folder};
    if (!folder_make(folder))
        return false;
    char *path = path_join(folder, "frames.json");
    bool good = path && output_open(&dump->index, path);
    free(path);
    if (!good)
        return false;
    dump->json = json_new();
    dump->frames = json_add_array(&dump->json, dump->json.root, "frames");
    return true;
}

static bool write_mesh(pir_sum *sum, const char *path) {
    pir_mesh *mesh = NULL;
    pir_report report = {0};
    pir_status status = pir_sum_mesh(sum, PIR_EXACT, &mesh);
    if (status == PIR_OK)
        status = pir_mesh_write(mesh, path, 1, &report);
    if (status != PIR_OK)
        complain_status(path, status, &report);
    pir_mesh_destroy(mesh);
    return status == PIR_OK;
}

bool dump_frame(struct dump *dump, pir_sum *sum, uint64_t frame) {
    char name[48];
    snprintf(name, sizeof name, "frame-%06" PRIu64 ".off", frame);
    char *path = path_join(dump->folder, name);
    bool good = path && write_mesh(sum, path);
    free(path);
    if (!good)
        return false;
    pir_quat q = pir_sum_rotation(sum);
    cJSON *entry = json_add_object(&dump->json, dump->frames, NULL);
    json_add_number(&dump->json, entry, "index", (double)frame);
    json_add_text(&dump->json, entry, "file", name);
    json_add_numbers(&dump->json, entry, "quat", (const double[]){q.x, q.y, q.z, q.w}, 4);
    return true;
}

bool dump_commit(struct dump *dump) {
    return json_print(&dump->json, dump->index.stream) && output_commit(&dump->index);
}

void dump_discard(struct dump *dump) {
    json_discard(&dump->json);
    output_discard(&dump->index);
}
