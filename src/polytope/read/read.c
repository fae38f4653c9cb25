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

static pir_status read_model(const char *data, size_t size, const char *format, struct pir_model *model) {
    pir_reader *read = reader_of(format);
    return read ? read(data, size, model)
                : pir_fail(model->report, PIR_ERR_ARGUMENT, "%s: '%.8s' is none of" PIR_READ_FORMATS(FORMAT_NAME),
                           model->name, format);
}

pir_read_options pir_read_options_default(void) {
    return (pir_read_options){.polytope = pir_polytope_options_default(), .require_convex = false};
}

pir_status pir_model_read_bytes(const pir_file_bytes *file, const pir_allocator *allocator, pir_report *report,
                                struct pir_model_maker maker) {
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
    pir_status status = read_model(file->bytes, file->size, file->format, &model);
    if (status == PIR_OK)
        status = maker.make(&model, maker.context);
    pir_model_finish(&model);
    pir_c_locale_leave(&locale);
    return status;
}

pir_status pir_model_read_file(const char *path, const pir_allocator *allocator, pir_report *report,
                               struct pir_model_maker maker) {
    const char *name = pir_short_name(path);
    const char *format = pir_format_of(path);
    if (pir_is_format(format, "svg"))
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: .svg files are written, not read", name);
    if (!reader_of(format))
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name ends in none of" PIR_READ_FORMATS(FORMAT_ENDING), name);
    struct pir_read_bytes bytes = {0};
    pir_status status = pir_file_read(path, allocator, report, &bytes);
    if (status == PIR_OK)
        status =
            pir_model_read_bytes(&(pir_file_bytes){bytes.data, bytes.size, path, format}, allocator, report, maker);
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

/* Checks the options that pir_model_make rests on. */
static pir_status check_options(const pir_read_options *options, const char *name, pir_report *report) {
    const pir_status status = pir_polytope_check_tolerance(options->polytope.merge_tolerance);
    if (status != PIR_OK)
        return pir_fail(report, status, "%s: the merge tolerance is %g", name, options->polytope.merge_tolerance);
    return PIR_OK;
}

pir_status pir_polytope_read_bytes(const pir_file_bytes *file, const pir_read_options *options, pir_report *report,
                                   pir_surface *ret_surface, pir_polytope **ret_polytope) {
    const pir_read_options used = options ? *options : pir_read_options_default();
    const char *name = file && file->name ? pir_short_name(file->name) : "text";
    if (!file || (!file->bytes && file->size > 0) || !file->format || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: no bytes, no format, or no place for the polytope", name);
    const pir_status status = check_options(&used, name, report);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.polytope.allocator);
    struct hull_maker maker = {&used, ret_surface, ret_polytope};
    return pir_model_read_bytes(file, &allocator, report, (struct pir_model_maker){make_hull, &maker});
}

pir_status pir_polytope_read_surface(const char *path, const pir_read_options *options, pir_report *report,
                                     pir_surface *ret_surface, pir_polytope **ret_polytope) {
    if (!path || !ret_polytope)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no path, or no place for the polytope");
    const pir_read_options used = options ? *options : pir_read_options_default();
    const pir_status status = check_options(&used, pir_short_name(path), report);
    if (status != PIR_OK)
        return status;
    const pir_allocator allocator = pir_allocator_or_default(used.polytope.allocator);
    struct hull_maker maker = {&used, ret_surface, ret_polytope};
    return pir_model_read_file(path, &allocator, report, (struct pir_model_maker){make_hull, &maker});
}

pir_status pir_polytope_read(const char *path, const pir_polytope_options *options, pir_report *report,
                             pir_polytope **ret_polytope) {
    pir_read_options used = pir_read_options_default();
    const pir_status status = pir_options_take("pir_polytope_options", options, &used.polytope, &report);
    if (status != PIR_OK)
        return status;
    return pir_polytope_read_surface(path, &used, report, NULL, ret_polytope);
}

pir_status pir_polytope_read_off(const char *text, size_t size, const char *name, const pir_polytope_options *options,
                                 pir_report *report, pir_polytope **ret_polytope) {
    pir_read_options used = pir_read_options_default();
    const pir_status status = pir_options_take("pir_polytope_options", options, &used.polytope, &report);
    if (status != PIR_OK)
        return status;
    return pir_polytope_read_bytes(&(pir_file_bytes){text, size, name, "off"}, &used, report, NULL, ret_polytope);
}
