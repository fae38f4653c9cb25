/* SPDX-License-Identifier: MIT */
/*
 * HDF5 that goes to an output file. Where a write fails, on a full disk, HDF5 can neither write nor close the file, and
 * some versions of it do not end. So it is not told: nothing more is written, and the output file knows why.
 */
#ifndef TOOLS_VIEWS_SINK_FILE_H
#define TOOLS_VIEWS_SINK_FILE_H

#include <hdf5.h>

#include "../file.h"

/* Zeroed it is closed. */
struct sink_file {
    hid_t driver, file;
};

/*
 * Makes a new file of HDF5 in an open output file, or opens what stands in it. It holds no times, so that equal runs
 * make equal files. False when HDF5 failed; sink_file_close releases what is there.
 */
bool sink_file_make(struct sink_file *sink, struct output_file *out);
bool sink_file_open(struct sink_file *sink, struct output_file *out);

/* False when HDF5 failed. What did not arrive is told by output_failed and output_commit. */
bool sink_file_close(struct sink_file *sink);

#endif
