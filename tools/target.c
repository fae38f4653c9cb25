/* SPDX-License-Identifier: MIT */
/* Targets of options; see target.h. */
#include "target.h"

#include <string.h>

#include <pirouette/io.h>

#include "message.h"

/* Room for an ending with its dot. */
#define ENDING_ROOM 8

/* The one of `endings` that `path` ends in, or NULL. */
static const char *ending_of(const char *path, const char *endings, char ret_ending[ENDING_ROOM]) {
    for (const char *at = strchr(endings, '.'); at; at = strchr(at + 1, '.')) {
        const size_t length = strcspn(at, " ,");
        memcpy(ret_ending, at, length < ENDING_ROOM ? length : ENDING_ROOM - 1);
        ret_ending[length < ENDING_ROOM ? length : ENDING_ROOM - 1] = '\0';
        if (output_ends_in(path, ret_ending))
            return ret_ending;
    }
    return NULL;
}

bool target_is_stdout(const struct args *args, const char *name) {
    const char *path = args_value(args, name);
    return path && output_is_stdout(path);
}

bool targets_differ(const struct args *args, const char *name, const char *other) {
    const char *path = args_value(args, name), *second = args_value(args, other);
    if (!path || !second || !output_same(path, second))
        return true;
    const char *where = output_is_stdout(path) ? "standard output" : path;
    complain("%s: %s and %s both write to %s", args->command->name, name, other, where);
    return false;
}

bool target_check(const struct args *args, const char *name, const char *endings) {
    const char *path = args_value(args, name);
    char ending[ENDING_ROOM];
    if (!path)
        return true;
    if (output_is_stdout(path) && args_has(args, "--json")) {
        complain("%s: %s %s and --json both print on standard output", args->command->name, name, path);
        return false;
    }
    if (!endings || output_is_stream(path) || ending_of(path, endings, ending))
        return true;
    complain("%s: %s: '%s' does not end in %s", args->command->name, name, path, endings);
    return false;
}

bool target_write_mesh(struct output_file *file, const pir_mesh *mesh, bool exact) {
    char ending[ENDING_ROOM];
    const char *format = ending_of(file->path, TARGET_MESH, ending), *name = file->path;
    pir_report report = {0};
    pir_status status = pir_mesh_write_stream(mesh, file->stream, strcmp(name, "-") == 0 ? "standard output" : name,
                                              format ? format + 1 : "off", exact, &report);
    if (status == PIR_OK)
        return output_commit(file);
    if (!output_failed(file))
        complain_status(name, status, &report);
    return false;
}
