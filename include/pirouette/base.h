/* SPDX-License-Identifier: MIT */
/**
 * Words that every part of Pirouette shares: status codes, error reports, vectors, quaternions, the allocator.
 *
 * Everything here is a plain value; nothing allocates, nothing is global.
 */
#ifndef PIROUETTE_BASE_H
#define PIROUETTE_BASE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define PIR_API __declspec(dllexport)
#elif defined(__GNUC__)
#define PIR_API __attribute__((visibility("default")))
#else
#define PIR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** How a call ended. Every call that can fail returns one; on anything but PIR_OK its `ret_`
    parameters are untouched. A call with a `capacity` writes as much as there is room for, and PIR_OK with the count of
    all there is says where that was too little: ask again with more room, or go without the rest. */
typedef enum pir_status {
    PIR_OK = 0,
    PIR_ERR_ARGUMENT,   /**< an argument breaks the call's contract: NULL, an index out of range, an unknown name */
    PIR_ERR_NOT_FINITE, /**< a coordinate, angle or quaternion component is NaN or infinite */
    PIR_ERR_ZERO_QUATERNION, /**< all four components of a quaternion are zero: it turns nothing */
    PIR_ERR_MEMORY,          /**< the allocator returned NULL; the objects involved are as before the call */
    PIR_ERR_EMPTY,           /**< no points, an empty file */
    PIR_ERR_FILE,            /**< a file cannot be opened, read or written */
    PIR_ERR_FORMAT, /**< a file's content breaks its format: truncated, counts that lie, a token that is no number */
    PIR_ERR_NOT_CLOSED, /**< facets that do not bound a solid, where a convex one is required */
    PIR_ERR_NOT_CONVEX, /**< a model that is not convex, where a convex one is required */
    PIR_ERR_LIMIT,      /**< too large for 32-bit indices or for a stated limit */
    PIR_ERR_NOT_BUILT,  /**< this build lacks what the call needs: HDF5, libccd */
    PIR_ERR_REGION,     /**< a sum with a region cannot answer this */
    PIR_ERR_VERSION,    /**< bytes of another version of their format, or options of another version of the library */
    PIR_ERR_INTERNAL,   /**< the result failed the library's own check and is withheld: a bug, please report it */
} pir_status;

/*
 * How objects end. An immutable object that others may hold counts its references: `_retain` takes one, `_release`
 * gives one back, and the last one frees. Any other object has one owner, who gives it to `_destroy`; it holds
 * references to what it stands on, so the order does not matter. All but `_retain` accept NULL.
 */

/*
 * Options. The first field of every struct of options is its size, in bytes, as these headers have it: begin with its
 * `_default` function, which sets it and all others, then change fields. So a library of another version knows what the
 * caller knew. Fields that the caller's struct lacks have their defaults; fields that the library lacks must be zero,
 * or the call is PIR_ERR_VERSION. A size that no struct has, 0 among them, is PIR_ERR_ARGUMENT. A report, where there
 * is one, names the struct. In C, {.size = sizeof options, …} does as well where zero is wanted in all other fields.
 * Any other struct is the same in all versions of one soname.
 */

/** The name of a status in plain words, such as "zero quaternion". Never NULL; static memory. O(1). */
PIR_API const char *pir_status_text(pir_status status);

/** An error in one line: its kind, place and cause. Plain memory of the caller; filled only when a call fails. */
typedef struct pir_report {
    pir_status status;
    char text[240]; /**< zero-terminated, without a newline; cut when too long */
} pir_report;

/** A point or vector; unit: that of the model. */
typedef struct pir_vec3 {
    double x, y, z;
} pir_vec3;

/** A quaternion x·i + y·j + z·k + w of any non-zero length: it stands for the exact rotation
    M(q)/|q|². Never normalised. Multiples of q, −q among them, are the same rotation, and have the same pairings. */
typedef struct pir_quat {
    double x, y, z, w;
} pir_quat;

/**
 * Where memory comes from. One function does it all:
 *
 *     resize(context, NULL, 0, n)    a new block of n bytes, aligned as malloc aligns, or NULL
 *     resize(context, p, old, n)     p grown or shrunk, or NULL with p left as it was
 *     resize(context, p, old, 0)     p released; the result is ignored
 *
 * Where NULL stands for an allocator it is malloc's. On Linux the kernel is then asked for huge pages where the arrays
 * of a polytope or a sum take 4 MiB and more, a hint.
 *
 * An allocator given to an object must outlive it. It is called only from the thread that called Pirouette. GMP's own
 * memory is used only where exact.h shows GMP types, where exact text is read or written, where facets are merged
 * (pir_polytope_options), where a mass or an exact motion is computed (mass.h), where the slack of an active set
 * (gradient.h) is one that doubles cannot tell from a facet's, and in work on solids (solid.h); the rest comes from
 * here.
 */
typedef struct pir_allocator {
    void *(*resize)(void *context, void *block, size_t old_size, size_t new_size);
    void *context;
} pir_allocator;

#ifdef __cplusplus
}
#endif

#endif
