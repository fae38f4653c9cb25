/* SPDX-License-Identifier: MIT */
/* A driver of HDF5; see sink_file.h. */
#include "sink_file.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

/* An open file as HDF5 knows it. HDF5's own part comes first. */
struct handle {
    H5FD_t own;
    struct output_file *out;
    haddr_t allocated; /* by HDF5 */
    haddr_t size;      /* of what stands in the file */
};

static H5FD_t *open_handle(const char *name, unsigned flags, hid_t access, haddr_t most) {
    (void)name;
    (void)most;
    struct output_file *const *out = H5Pget_driver_info(access);
    struct handle *handle = out ? H5allocate_memory(sizeof *handle, true) : NULL;
    if (!handle)
        return NULL;
    handle->out = *out;
    if (flags & H5F_ACC_TRUNC)
        output_cut(*out, 0);
    handle->size = output_size(*out);
    return &handle->own;
}

static herr_t close_handle(H5FD_t *file) {
    return H5free_memory(file);
}

static haddr_t get_end(const H5FD_t *file, H5FD_mem_t type) {
    (void)type;
    return ((const struct handle *)file)->allocated;
}

static herr_t set_end(H5FD_t *file, H5FD_mem_t type, haddr_t end) {
    (void)type;
    ((struct handle *)file)->allocated = end;
    return 0;
}

static haddr_t file_end(const H5FD_t *file, H5FD_mem_t type) {
    (void)type;
    return ((const struct handle *)file)->size;
}

static herr_t tell_features(const H5FD_t *file, unsigned long *features) {
    (void)file;
    *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
                H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

static herr_t read_bytes(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t at, size_t size, void *data) {
    (void)type;
    (void)transfer;
    return output_read_at(((struct handle *)file)->out, data, size, at) ? 0 : -1;
}

static herr_t write_bytes(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t at, size_t size, const void *data) {
    struct handle *handle = (struct handle *)file;
    (void)type;
    (void)transfer;
    output_write_at(handle->out, data, size, at);
    handle->size = at + size > handle->size ? at + size : handle->size;
    return 0;
}

static herr_t cut_or_lengthen(H5FD_t *file, hid_t transfer, hbool_t closing) {
    struct handle *handle = (struct handle *)file;
    (void)transfer;
    (void)closing;
    if (handle->size != handle->allocated)
        output_cut(handle->out, handle->allocated);
    handle->size = handle->allocated;
    return 0;
}

static const H5FD_class_t driver_class = {
#if H5_VERSION_GE(1, 13, 0)
    .version = H5FD_CLASS_VERSION,
    .value = 510, // of those for testing: it is registered under a name alone
#endif
    .name = "pirouette_sink",
    .maxaddr = ((haddr_t)1 << 63) - 1,
    .fc_degree = H5F_CLOSE_WEAK,
    .fapl_size = sizeof(struct output_file *),
    .open = open_handle,
    .close = close_handle,
    .query = tell_features,
    .get_eoa = get_end,
    .set_eoa = set_end,
    .get_eof = file_end,
    .read = read_bytes,
    .write = write_bytes,
    .truncate = cut_or_lengthen,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

static bool begin(struct sink_file *sink, struct output_file *out, bool make) {
    hid_t create = H5Pcreate(H5P_FILE_CREATE), access = H5Pcreate(H5P_FILE_ACCESS);
    *sink = (struct sink_file){.driver = H5FDregister(&driver_class)};
    if (sink->driver > 0 && create >= 0 && access >= 0 && H5Pset_obj_track_times(create, false) >= 0 &&
        H5Pset_driver(access, sink->driver, &out) >= 0)
        sink->file =
            make ? H5Fcreate(out->path, H5F_ACC_TRUNC, create, access) : H5Fopen(out->path, H5F_ACC_RDWR, access);
    if (create >= 0)
        H5Pclose(create);
    if (access >= 0)
        H5Pclose(access);
    return sink->file > 0;
}

bool sink_file_make(struct sink_file *sink, struct output_file *out) {
    return begin(sink, out, true);
}

bool sink_file_open(struct sink_file *sink, struct output_file *out) {
    return begin(sink, out, false);
}

bool sink_file_close(struct sink_file *sink) {
    bool done = sink->file <= 0 || H5Fclose(sink->file) >= 0;
    // HDF5 needs the driver until it has closed the file
    if (sink->driver > 0)
        H5FDunregister(sink->driver);
    *sink = (struct sink_file){0};
    return done;
}
