/* SPDX-License-Identifier: MIT */
/* Pieces by file or folder. The objects of an OBJ file are read one by one, by the reader of OBJ. */
#include "pieces.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "file.h"
#include "message.h"
#include "model.h"
#include "objects.h"

static bool no_memory(const struct args *args) {
    complain("%s: out of memory", args->command->name);
    return false;
}

/* Takes the polytope, or releases it; NULL, after a complaint, gives false. */
static bool add(const struct args *args, struct pieces *pieces, pir_polytope *piece) {
    if (!piece)
        return false;
    if (pieces->count == pieces->room) {
        uint32_t room = pieces->room ? 2 * pieces->room : 16;
        pir_polytope **grown = realloc(pieces->at, room * sizeof *grown);
        if (!grown) {
            pir_polytope_release(piece);
            return no_memory(args);
        }
        pieces->at = grown;
        pieces->room = room;
    }
    pieces->at[pieces->count++] = piece;
    return true;
}

void pieces_release(struct pieces *pieces) {
    for (uint32_t i = 0; i < pieces->count; i++)
        pir_polytope_release(pieces->at[i]);
    free(pieces->at);
    *pieces = (struct pieces){0};
}

/* --- one file --- */

/* The file as text that ends in a zero, to be freed; NULL, without a complaint, when it cannot be read. */
static char *read_text(const char *path) {
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, room = 0;
    while (file && !ferror(file) && !feof(file)) {
        if (used + 1 >= room) {
            char *grown = realloc(text, room = room ? 2 * room : 65536);
            if (!grown)
                break;
            text = grown;
        }
        used += fread(text + used, 1, room - used - 1, file);
    }
    bool good = file && !ferror(file) && feof(file);
    if (file)
        fclose(file);
    if (!good) {
        free(text);
        return NULL;
    }
    text[used] = '\0';
    return text;
}

/* The objects of an OBJ text of several. */
static bool load_objects(const struct args *args, const char *path, const char *text, struct pieces *pieces) {
    bool good = true;
    for (size_t i = 0; good && i < objects_count(text); i++) {
        char *object = objects_text(text, i);
        if (!object)
            return no_memory(args);
        good = add(args, pieces, model_of_text(args, path, object, "obj"));
        free(object);
    }
    return good;
}

static bool load_file(const struct args *args, const char *path, struct pieces *pieces) {
    char *text = output_ends_in(path, ".obj") ? read_text(path) : NULL;
    bool good;
    if (text && objects_count(text) > 1)
        good = load_objects(args, path, text, pieces);
    else
        good = add(args, pieces, model_of_path(args, path, NULL));
    free(text);
    return good;
}

/* --- a folder --- */

#define ENDING(format) " ." #format

static int compare_names(const void *a, const void *b) {
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static bool is_model(const char *name) {
#define OR_ENDS_IN(format) || output_ends_in(name, "." #format)
    return false PIR_READ_FORMATS(OR_ENDS_IN);
#undef OR_ENDS_IN
}

/* The names of models in a folder, sorted, each to be freed. */
static bool list_models(const struct args *args, const char *folder, char ***ret_names, size_t *ret_count) {
    DIR *entries = opendir(folder);
    if (!entries) {
        complain("%s: %s: cannot open: %s", args->command->name, folder, strerror(errno));
        return false;
    }
    bool good = true;
    for (struct dirent *entry; good && (entry = readdir(entries));) {
        if (!is_model(entry->d_name))
            continue;
        char **grown = realloc(*ret_names, (*ret_count + 1) * sizeof *grown);
        char *path = grown ? path_join(folder, entry->d_name) : NULL;
        if (grown)
            *ret_names = grown;
        if (path)
            grown[(*ret_count)++] = path;
        // joining has complained itself
        good = grown ? path != NULL : no_memory(args);
    }
    closedir(entries);
    if (good && *ret_count > 0)
        qsort(*ret_names, *ret_count, sizeof **ret_names, compare_names);
    if (good && *ret_count == 0)
        complain("%s: %s: the folder has none of" PIR_READ_FORMATS(ENDING), args->command->name, folder);
    return good && *ret_count > 0;
}

static bool load_folder(const struct args *args, const char *folder, struct pieces *pieces) {
    char **names = NULL;
    size_t count = 0;
    bool good = list_models(args, folder, &names, &count);
    for (size_t i = 0; i < count; i++) {
        good = good && load_file(args, names[i], pieces);
        free(names[i]);
    }
    free(names);
    return good;
}

bool pieces_load(const struct args *args, size_t index, struct pieces *pieces) {
    const char *path = args->positional[index];
    struct stat is;
    if (stat(path, &is) == 0 && S_ISDIR(is.st_mode))
        return load_folder(args, path, pieces);
    return load_file(args, path, pieces);
}
