/* SPDX-License-Identifier: MIT */
/* Standard input, as a model or as lines. Functions that return false or NULL have complained. */
#ifndef TOOLS_INPUT_H
#define TOOLS_INPUT_H

#include <stdbool.h>
#include <stddef.h>

#include <pirouette/io.h>

/* The name of standard input in complaints. */
#define INPUT_NAME "standard input"

/* Whether `path` is "-". */
bool input_is_stdin(const char *path);

/* Takes standard input for the caller. It can be read once: false when it is taken already. */
bool input_take(void);

/* Takes standard input and reads all of it, a model as OFF; input_end_model is to be called once it has been read. */
bool input_begin_model(pir_file_bytes *ret_file);

/* Frees the bytes, and complains of a status that is no success; the status. */
pir_status input_end_model(const pir_file_bytes *file, pir_status status, const pir_report *report);

#endif
