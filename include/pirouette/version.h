/* SPDX-License-Identifier: MIT */
/**
 * The version: of these headers as macros, of the library that runs as a call.
 *
 * The soname is the whole version until 1.0, and then the major one. Versions of one soname have the same functions,
 * structs and enumerators, and may have more: fields are added to structs of options alone, behind the others.
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
