/* SPDX-License-Identifier: MIT */
/* See models.h. The objects of an OBJ file are read one by one, by the reader of OBJ. */
#include "models.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <pirouette/io.h>

#include "file.h"
#include "message.h"
#include "model.h"
#include "objects.h"

static bool no_memory(const struct args *args) {
    complain("%s: out of memory", args->command->name);
    return false;
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
static bool each_object(const struct args *args, const char *path, const char *text, model_taker *take, void *context) {
    bool good = true;
    for (size_t i = 0; good && i < objects_count(text); i++) {
        char *object = objects_text(text, i), *name = objects_name(text, i);
        good = object && name ? take(context, &(struct found_model){path, name, object}) : no_memory(args);
        free(object);
        free(name);
    }
    return good;
}

static bool each_of_file(const struct args *args, const char *path, model_taker *take, void *context) {
    char *text = output_ends_in(path, ".obj") ? read_text(path) : NULL;
    const bool good = text && objects_count(text) > 1
                          ? each_object(args, path, text, take, context)
                          : take(context, &(struct found_model){path, model_title(path), NULL});
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

static bool each_of_folder(const struct args *args, const char *folder, model_taker *take, void *context) {
    char **names = NULL;
    size_t count = 0;
    bool good = list_models(args, folder, &names, &count);
    for (size_t i = 0; i < count; i++) {
        good = good && each_of_file(args, names[i], take, context);
        free(names[i]);
    }
    free(names);
    return good;
}

bool models_each(const struct args *args, const char *path, model_taker *take, void *context) {
    struct stat is;
    const bool is_there = stat(path, &is) == 0,
               is_file = strcmp(path, "-") != 0 && strncmp(path, MODEL_SHAPE, strlen(MODEL_SHAPE)) != 0;
    if (!is_there && is_file) {
        complain("%s: %s: cannot open: %s", args->command->name, path, strerror(errno));
        return false;
    }
    if (is_there && S_ISDIR(is.st_mode))
        return each_of_folder(args, path, take, context);
    return each_of_file(args, path, take, context);
}
