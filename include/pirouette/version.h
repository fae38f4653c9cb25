/* SPDX-License-Identifier: MIT */
/**
 * The version: of these headers as macros, of the library that runs as a call.
 */
#ifndef PIROUETTE_VERSION_H
#define PIROUETTE_VERSION_H

#include <pirouette/base.h>

#define PIR_VERSION_MAJOR  0
#define PIR_VERSION_MINOR  2
#define PIR_VERSION_PATCH  0
#define PIR_VERSION_STRING "0.2.0"

#ifdef __cplusplus
extern "C" {
#endif

/** The version of the library at run time, "major.minor.patch"; static memory. O(1). */
PIR_API const char *pir_version(void);

#ifdef __cplusplus
}
#endif

#endif
