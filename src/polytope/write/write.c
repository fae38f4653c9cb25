/* SPDX-License-Identifier: MIT */
/*
 * Meshes into files: which writer, and a file that is whole or as it was before.
 *
 * A regular file is written under a name of its own in the same folder, opened so that it cannot already exist, and
 * renamed to its target only when every byte is down; on any failure it is removed. The target is what the path leads
 * to when all links are followed. A device or a FIFO cannot be replaced by a file, so it is opened and written to.
 */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <pirouette/io.h>

#include "base/report.h"
#include "polytope/file/file_name.h"
#include "polytope/file/target.h"
#include "polytope/write/write_obj.h"
#include "polytope/write/write_off.h"
#include "polytope/write/write_ply.h"
#include "polytope/write/write_stl.h"
#include "polytope/write/write_svg.h"

/*
 * Names tried for the file beside the target before giving up: one for each thread that writes into the folder at
 * once.
 */
#define TEMPORARY_NAMES 100

/* --- one mesh to an open stream --- */

static pir_status fail_file(pir_report *report, const char *path, int error) {
    return pir_fail(report, PIR_ERR_FILE, "%s: cannot write: %s", pir_short_name(path), strerror(error));
}

/* Whether the format can hold the mesh that exactly. */
static pir_status check_exact(const pir_mesh *mesh, const char *name, enum pir_file_type type, bool exact,
                              pir_report *report) {
    if (exact && type != PIR_FILE_OFF)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: only .off holds exact coordinates", name);
    if (exact && !pir_mesh_is_exact(mesh))
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the mesh holds no exact coordinates", name);
    return PIR_OK;
}

static pir_status write_as(const pir_mesh *mesh, FILE *file, const char *name, enum pir_file_type type, bool exact,
                           pir_report *report) {
    pir_status status = PIR_OK;
    if (type == PIR_FILE_STL)
        return pir_mesh_write_stl(mesh, file, name, report);
    if (type == PIR_FILE_PLY)
        pir_mesh_write_ply(mesh, file);
    else if (type == PIR_FILE_OBJ)
        status = pir_mesh_write_obj(mesh, file);
    else if (type == PIR_FILE_SVG)
        status = pir_mesh_write_svg(mesh, file);
    else
        status = pir_mesh_write_off(mesh, file, exact != 0);
    return status == PIR_OK ? PIR_OK : pir_fail(report, status, "%s: cannot write: %s", name, pir_status_text(status));
}

/* Writes and flushes; a full disk may show only at the end. */
static pir_status write_stream(const pir_mesh *mesh, FILE *file, const char *path, enum pir_file_type type, bool exact,
                               pir_report *report) {
    pir_status status = write_as(mesh, file, pir_short_name(path), type, exact, report);
    errno = 0;
    if ((fflush(file) != 0 || ferror(file)) && status == PIR_OK)
        status = fail_file(report, path, errno ? errno : EIO);
    return status;
}

pir_status pir_mesh_write_stream(const pir_mesh *mesh, FILE *file, const char *name, const char *format, bool exact,
                                 pir_report *report) {
    if (!mesh || !file || !name || !format)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no mesh, no stream, no name or no format");
    enum pir_file_type type = pir_file_type_named(format);
    if (type == PIR_FILE_UNKNOWN)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: '%.32s' is none of off, obj, stl, ply and svg",
                        pir_short_name(name), format);
    pir_status status = check_exact(mesh, pir_short_name(name), type, exact, report);
    return status == PIR_OK ? write_stream(mesh, file, name, type, exact, report) : status;
}

/* --- files --- */

/* A new file in the folder of `target`; its name to ret_name. NULL with errno set on failure. */
static FILE *open_beside(const char *target, char ret_name[PIR_PATH_SIZE]) {
    const char *slash = strrchr(target, '/');
    int folder = slash ? (int)(slash + 1 - target) : 0;
    for (int i = 0; i < TEMPORARY_NAMES; i++) {
        int length = snprintf(ret_name, PIR_PATH_SIZE, "%.*s.pirouette-%ld-%d", folder, target, (long)getpid(), i);
        if (length >= PIR_PATH_SIZE) {
            errno = ENAMETOOLONG;
            return NULL;
        }
        FILE *file = fopen(ret_name, "wbx");
        if (file || errno != EEXIST)
            return file;
    }
    return NULL;
}

/* A mesh to be written, and its destination. */
struct write_job {
    const pir_mesh *mesh;
    const char *path;
    bool exact;
    pir_report *report;
};

/* Writes to the open file and closes it. */
static pir_status write_and_close(const struct write_job *job, FILE *file) {
    pir_status status = write_stream(job->mesh, file, job->path, pir_file_type_of(job->path), job->exact, job->report);
    if (fclose(file) != 0 && status == PIR_OK)
        status = fail_file(job->report, job->path, errno);
    return status;
}

/* To a name beside the target, which then takes its place; `old` is what is there now, or NULL. */
static pir_status replace(const struct write_job *job, const char *target, const struct stat *old) {
    char temporary[PIR_PATH_SIZE];
    if (old && access(target, W_OK) != 0)
        return fail_file(job->report, job->path, errno);
    FILE *file = open_beside(target, temporary);
    if (!file)
        return fail_file(job->report, job->path, errno);
    if (old)
        fchmod(fileno(file), old->st_mode & 07777);
    pir_status status = write_and_close(job, file);
    if (status == PIR_OK && rename(temporary, target) != 0)
        status = fail_file(job->report, job->path, errno);
    if (status != PIR_OK)
        remove(temporary);
    return status;
}

static pir_status write_file(const struct write_job *job) {
    struct stat there;
    if (stat(job->path, &there) == 0 && !S_ISREG(there.st_mode)) {
        FILE *file = fopen(job->path, "wb");
        return file ? write_and_close(job, file) : fail_file(job->report, job->path, errno);
    }
    char target[PIR_PATH_SIZE];
    if (!pir_follow_links(job->path, target))
        return fail_file(job->report, job->path, errno);
    return replace(job, target, stat(target, &there) == 0 ? &there : NULL);
}

pir_status pir_mesh_write(const pir_mesh *mesh, const char *path, bool exact, pir_report *report) {
    if (!mesh || !path)
        return pir_fail(report, PIR_ERR_ARGUMENT, "no mesh, or no path to write it to");
    const char *name = pir_short_name(path);
    enum pir_file_type type = pir_file_type_of(path);
    if (type == PIR_FILE_UNKNOWN)
        return pir_fail(report, PIR_ERR_ARGUMENT, "%s: the name does not end in .off, .obj, .stl, .ply or .svg", name);
    pir_status status = check_exact(mesh, name, type, exact, report);
    return status == PIR_OK ? write_file(&(struct write_job){mesh, path, exact, report}) : status;
}
