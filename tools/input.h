/* SPDX-License-Identifier: MIT */
/* Standard input, as a model or as lines. Functions that return false or NULL have complained. */
#ifndef TOOLS_INPUT_H
#define TOOLS_INPUT_H

#include <stdbool.h>
#include <stddef.h>

/* What stands for standard input in complaints. */
#define INPUT_NAME "standard input"

/* Whether `path` is "-". */
bool input_is_stdin(const char *path);

/* Takes standard input for the caller. It can be read once: false when it is taken already. */
bool input_take(void);

/* All of standard input, to be freed; its size to *ret_size. */
char *input_read(size_t *ret_size);

#endif
