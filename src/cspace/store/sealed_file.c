/* SPDX-License-Identifier: MIT */
/* A driver of HDF5, through which it reads a sealed file: a block that is not as it was written cannot be read. */
#include "cspace/store/sealed_file.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include "base/report.h"

/* An open file as HDF5 knows it. HDF5's own part comes first. */
struct handle {
    H5FD_t own;
    pir_sealed *sealed;
    haddr_t end; /* of what HDF5 has allocated in it */
};

static H5FD_t *open_handle(const char *name, unsigned flags, hid_t access, haddr_t most) {
    (void)name;
    (void)most;
    pir_sealed *const *sealed = H5Pget_driver_info(access);
    if (!sealed || (flags & H5F_ACC_RDWR))
        return NULL;
    struct handle *handle = H5allocate_memory(sizeof *handle, true);
    if (!handle)
        return NULL;
    handle->sealed = *sealed;
    return &handle->own;
}

static herr_t close_handle(H5FD_t *file) {
    return H5free_memory(file);
}

static haddr_t get_end(const H5FD_t *file, H5FD_mem_t type) {
    (void)type;
    return ((const struct handle *)file)->end;
}

static herr_t set_end(H5FD_t *file, H5FD_mem_t type, haddr_t end) {
    (void)type;
    ((struct handle *)file)->end = end;
    return 0;
}

static haddr_t file_end(const H5FD_t *file, H5FD_mem_t type) {
    (void)type;
    return ((const struct handle *)file)->sealed->size;
}

static herr_t tell_features(const H5FD_t *file, unsigned long *features) {
    (void)file;
    *features = H5FD_FEAT_DATA_SIEVE;
    return 0;
}

static herr_t read_bytes(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t at, size_t size, void *data) {
    (void)type;
    (void)transfer;
    return pir_sealed_read(((struct handle *)file)->sealed, at, size, data) ? 0 : -1;
}

static herr_t write_bytes(H5FD_t *file, H5FD_mem_t type, hid_t transfer, haddr_t at, size_t size, const void *data) {
    (void)file;
    (void)type;
    (void)transfer;
    (void)at;
    (void)size;
    (void)data;
    return -1;
}

static const H5FD_class_t driver_class = {
#if H5_VERSION_GE(1, 13, 0)
    .version = H5FD_CLASS_VERSION,
    .value = 511, // of those for testing: it is registered under a name alone
#endif
    .name = "pirouette_sealed",
    .maxaddr = ((haddr_t)1 << 63) - 1,
    .fc_degree = H5F_CLOSE_WEAK,
    .fapl_size = sizeof(pir_sealed *),
    .open = open_handle,
    .close = close_handle,
    .query = tell_features,
    .get_eoa = get_end,
    .set_eoa = set_end,
    .get_eof = file_end,
    .read = read_bytes,
    .write = write_bytes,
    .fl_map = H5FD_FLMAP_DICHOTOMY,
};

pir_status pir_sealed_file_open(pir_sealed_file *file, const char *path, const pir_allocator *allocator,
                                pir_report *report) {
    *file = (pir_sealed_file)PIR_NO_SEALED_FILE;
    pir_status status = pir_sealed_open(&file->sealed, path, allocator, report);
    if (status != PIR_OK)
        return status;
    pir_sealed *sealed = &file->sealed;
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    file->driver = H5FDregister(&driver_class);
    if (access >= 0 && file->driver >= 0 && H5Pset_driver(access, file->driver, &sealed) >= 0)
        file->file = H5Fopen(path, H5F_ACC_RDONLY, access);
    if (access >= 0)
        H5Pclose(access);
    if (file->file >= 0)
        return PIR_OK;
    status = pir_sealed_tell(sealed, path, report);
    return status != PIR_OK ? status : pir_fail(report, PIR_ERR_FORMAT, "%s: the file: it is no HDF5", path);
}

void pir_sealed_file_close(pir_sealed_file *file) {
    if (file->file >= 0)
        H5Fclose(file->file);
    // HDF5 needs the driver until it has closed the file
    if (file->driver >= 0)
        H5FDunregister(file->driver);
    pir_sealed_close(&file->sealed);
    *file = (pir_sealed_file)PIR_NO_SEALED_FILE;
}
