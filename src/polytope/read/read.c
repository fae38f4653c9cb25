/* SPDX-License-Identifier: MIT */
/* Reading models: the whole file into memory, then the reader of its format, then the hull of what that made of it. */
#include <pirouette/io.h>

#include "base/memory.h"
#include "base/options.h"
#include "base/report.h"
#include "polytope/create/create.h"
#include "polytope/file/c_locale.h"
#include "polytope/file/file_bytes.h"
#include "polytope/file/file_name.h"
#include "polytope/read/model_make.h"
#include "polytope/read/read.h"
#include "polytope/read/readers.h"

#define FORMAT_NAME(name)   " " #name
#define FORMAT_ENDING(name) " ." #name

/* The reader of that format, in either case; NULL where there is none. */
static pir_reader *reader_of(const char *format) {
#define ROW(name) {#name, pir_read_##name},
    static const struct {
        const char *name;
        pir_reader *read;
    } readers[] = {PIR_READ_FORMATS(ROW)};
#undef ROW
    for (size_t i = 0; i < sizeof readers / sizeof *readers; i++)
        if (pir_is_format(format, readers[i].name))
            return readers[i].read;
    return NULL;
}

/*
 * The reader of a file of that format; where `format` is NULL, by the ending of `path`, which may be NULL then too.
 * PIR_ERR_ARGUMENT.
 */
static pir_status find_reader(const char *path, const char *format, pir_report *report, pir_reader **ret_reader) {
    const char *name = path ? pir_short_name(path) : "text";
    const char *by = format ? format : path ? pir_format_of(path) : "";
    pir_reader *reader = reader_of(by);
    if (reader) {
        *ret_reader = reader;
        return PIR_OK;
    }
    if (format)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: '%.8s' is none of" PIR_READ_FORMATS(FORMAT_NAME), name, format);
    if (pir_is_format(by, "svg"))
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .svg files are written, not read", name);
    return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name ends in none of" PIR_READ_FORMATS(FORMAT_ENDING), name);
}

pir_status pir_model_read_bytes(const pir_file_bytes *file, const pir_allocator *allocator, pir_report *report,
                                struct pir_model_maker maker) {
    pir_reader *read;
    pir_status status = find_reader(file->name, file->format, report, &read);
    if (status != PIR_OK)
        return status;
    const char *name = file->name ? pir_short_name(file->name) : "text";
    if (file->size == 0)
        return pir_fail(report, PIR_ERR_EMPTY, "%s: the file is empty", name);
    if (file->size > PIR_FILE_SIZE_MAX)
        return pir_fail(report, PIR_ERR_LIMIT, "%s: larger than 2 GiB", name);
    struct pir_c_locale locale;
    if (!pir_c_locale_enter(&locale))
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", name);
    struct pir_model model;
    pir_model_init(&model, name, allocator, report);
    status = read(file->bytes, file->size, &model);
    if (status == PIR_OK)
        status = maker.make(&model, maker.context);
    pir_model_finish(&model);
    pir_c_locale_leave(&locale);
    return status;
}

pir_status pir_model_read_file(const char *path, const pir_allocator *allocator, pir_report *report,
                               struct pir_model_maker maker) {
    pir_reader *read;
    struct pir_read_bytes bytes = {0};
    // a name of no format is refused before the file is looked at
    pir_status status = find_reader(path, NULL, report, &read);
    if (status == PIR_OK)
        status = pir_file_read(path, allocator, report, &bytes);
    if (status == PIR_OK)
        status = pir_model_read_bytes(&(pir_file_bytes){bytes.data, bytes.size, path, NULL}, allocator, report, maker);
    PIR_FREE(allocator, bytes.data, bytes.capacity);
    return status;
}

/* A hull to be made of a model, and where it goes. */
struct hull_maker {
    const pir_read_options *options;
    pir_surface *surface;
    pir_polytope **polytope;
};

static pir_status make_hull(const struct pir_model *model, void *context) {
    const struct hull_maker *maker = context;
    return pir_model_make(model, maker->options, maker->surface, maker->polytope);
}

/* Takes the options for a file of that name, and checks what pir_model_make rests on. */
static pir_status take_options(const pir_read_options *options, const char *name, pir_report *report,
                               pir_read_options *used) {
    *used = pir_read_options_default();
    pir_status status = pir_options_take("pir_read_options", options, used, &report);
    if (status != PIR_OK)
        return status;
    status = pir_polytope_check_tolerance(used->merge_tolerance);
    return status == PIR_OK ? PIR_OK
                            : pir_fail(report, status, "%s: the merge tolerance is %g", name, used->merge_tolerance);
}

pir_status pir_polytope_read_bytes(const pir_file_bytes *file, const pir_read_options *options, pir_report *report,
                                   pir_surface *ret_surface, pir_polytope **ret_polytope) {
    const char *name = file && file->name ? pir_short_name(file->name) : "text";
    if (!file || (!file->bytes && file->size > 0) || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: no bytes, or no place for the polytope", name);
    pir_read_options used;
    const pir_status status = take_options(options, name, report, &used);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    struct hull_maker maker = {&used, ret_surface, ret_polytope};
    return pir_model_read_bytes(file, &allocator, report, (struct pir_model_maker){make_hull, &maker});
}

pir_status pir_polytope_read(const char *path, const pir_read_options *options, pir_report *report,
                             pir_surface *ret_surface, pir_polytope **ret_polytope) {
    if (!path || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the polytope");
    pir_read_options used;
    const pir_status status = take_options(options, pir_short_name(path), report, &used);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.allocator);
    struct hull_maker maker = {&used, ret_surface, ret_polytope};
    return pir_model_read_file(path, &allocator, report, (struct pir_model_maker){make_hull, &maker});
}
