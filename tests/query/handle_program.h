/* SPDX-License-Identifier: MIT */
/*
 * Reads any bytes as a program that makes, changes, uses and destroys objects in any order: bodies, sums, clones,
 * sums restored from bytes, queries, live meshes, cubical maps and their locators. A model beside them knows each
 * answer: that of new objects, made from bodies at the scale, rotation and region that the model has.
 */
#ifndef PIR_TEST_HANDLE_PROGRAM_H
#define PIR_TEST_HANDLE_PROGRAM_H

#include <stddef.h>
#include <stdint.h>

/*
 * Runs the program. Returns NULL where everything was right, otherwise what was wrong. *ret_step then is the number
 * of the step, from 0.
 */
const char *handle_program_run(const uint8_t *data, size_t size, uint32_t *ret_step);

#endif
