/* SPDX-License-Identifier: MIT */
/* Seals, written and read. */
#include "cspace/store/seal.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <pirouette/cspace.h>

#include "base/report.h"

/* Hashes in a block of them. */
#define HASHES (PIR_SEAL_BLOCK / PIR_SEAL_HASH)

/* The last bytes of a sealed file, and where parts of them stand. */
enum { END_SIZE = 64, END_OF_SIZE = 8, END_OF_UPPER = 32, END_OF_HASH = 48 };

static const uint8_t magic[8] = {'P', 'I', 'R', 'S', 'E', 'A', 'L', '1'};
static const uint8_t hdf5[8] = {0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};

static void hash_of(const void *data, size_t size, uint8_t ret_hash[PIR_SEAL_HASH]) {
    XXH128_canonical_t hash;
    XXH128_canonicalFromHash(&hash, XXH3_128bits(data, size));
    memcpy(ret_hash, hash.digest, PIR_SEAL_HASH);
}

static bool has_hash(const void *data, size_t size, const uint8_t *expected) {
    uint8_t hash[PIR_SEAL_HASH];
    hash_of(data, size, hash);
    return memcmp(hash, expected, PIR_SEAL_HASH) == 0;
}

/* Blocks of so many bytes. */
static uint64_t blocks_of(uint64_t size) {
    return size / PIR_SEAL_BLOCK + (size % PIR_SEAL_BLOCK != 0);
}

/* The bytes of a block, of so many in all. */
static size_t block_size(uint64_t size, uint64_t block) {
    uint64_t left = size - block * PIR_SEAL_BLOCK;
    return left < PIR_SEAL_BLOCK ? (size_t)left : PIR_SEAL_BLOCK;
}

/* Reads exactly so many bytes; false, with errno, where that cannot be, with 0 where the file is shorter. */
static bool read_at(int descriptor, void *data, size_t size, uint64_t at) {
    for (size_t done = 0; done < size;) {
        ssize_t got = pread(descriptor, (char *)data + done, size - done, (off_t)(at + done));
        if (got == 0)
            errno = 0;
        if (got == 0 || (got < 0 && errno != EINTR))
            return false;
        done += got > 0 ? (size_t)got : 0;
    }
    return true;
}

static bool write_at(int descriptor, const void *data, size_t size, uint64_t at) {
    for (size_t done = 0; done < size;) {
        ssize_t put = pwrite(descriptor, (const char *)data + done, size - done, (off_t)(at + done));
        if (put < 0 && errno != EINTR)
            return false;
        done += put > 0 ? (size_t)put : 0;
    }
    return true;
}

/* --- the end --- */

static void write_end(uint64_t size, const void *upper, size_t upper_size, uint8_t end[END_SIZE]) {
    memset(end, 0, END_SIZE);
    memcpy(end, magic, sizeof magic);
    for (int i = 0; i < 8; i++)
        end[END_OF_SIZE + i] = (uint8_t)(size >> 8 * i);
    hash_of(upper, upper_size, end + END_OF_UPPER);
    hash_of(end, END_OF_HASH, end + END_OF_HASH);
}

/* The bytes of the hashes of hashes, where a file of `whole` bytes with this end can be a sealed one; else 0. */
static uint64_t read_end(const uint8_t end[END_SIZE], uint64_t whole, uint64_t *ret_size) {
    if (memcmp(end, magic, sizeof magic) != 0 || !has_hash(end, END_OF_HASH, end + END_OF_HASH))
        return 0;
    uint64_t size = 0;
    for (int i = 0; i < 8; i++)
        size |= (uint64_t)end[END_OF_SIZE + i] << 8 * i;
    if (size == 0 || size >= whole)
        return 0;
    const uint64_t hashes = blocks_of(size) * PIR_SEAL_HASH, upper = blocks_of(hashes) * PIR_SEAL_HASH;
    *ret_size = size;
    return size + hashes + upper + END_SIZE == whole ? upper : 0;
}

/* --- reading --- */

/* Reads the hashes of hashes. Returns why the file is no sealed one, or NULL. */
static const char *read_seal(pir_sealed *sealed, uint64_t whole) {
    uint8_t begin[sizeof hdf5], end[END_SIZE];
    if (whole < sizeof begin || !read_at(sealed->descriptor, begin, sizeof begin, 0) ||
        memcmp(begin, hdf5, sizeof begin) != 0)
        return "it is no HDF5";
    static const char *const none = "no seal at its end: truncated, changed by another program, or of a version before";
    if (whole < END_SIZE || !read_at(sealed->descriptor, end, END_SIZE, whole - END_SIZE))
        return none;
    const uint64_t upper = read_end(end, whole, &sealed->size);
    if (upper == 0)
        return none;
    sealed->upper = PIR_NEW(&sealed->allocator, uint8_t, (size_t)upper);
    if (!sealed->upper)
        return "out of memory";
    sealed->upper_size = (size_t)upper;
    if (!read_at(sealed->descriptor, sealed->upper, (size_t)upper, whole - END_SIZE - upper) ||
        !has_hash(sealed->upper, (size_t)upper, end + END_OF_UPPER))
        return "its seal is damaged";
    sealed->kept = PIR_NEW(&sealed->allocator, pir_sealed_block, PIR_SEAL_KEPT + 1);
    if (!sealed->kept)
        return "out of memory";
    for (int i = 0; i <= PIR_SEAL_KEPT; i++)
        sealed->kept[i].number = UINT64_MAX;
    return NULL;
}

pir_status pir_sealed_open(pir_sealed *sealed, const char *path, const pir_allocator *allocator, pir_report *report) {
    *sealed = (pir_sealed){.allocator = pir_allocator_or_default(allocator)};
    struct stat file;
    // what is no regular file is not waited for
    sealed->descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (sealed->descriptor < 0 || fstat(sealed->descriptor, &file) != 0)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot open: %s", path, strerror(errno));
    if (!S_ISREG(file.st_mode))
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot open: it is no regular file", path);
    const char *why = read_seal(sealed, (uint64_t)file.st_size);
    if (!why)
        return PIR_OK;
    const bool no_memory = strcmp(why, "out of memory") == 0;
    return pir_fail(report, no_memory ? PIR_ERR_MEMORY : PIR_ERR_FORMAT, "%s: the file: %s", path, why);
}

void pir_sealed_close(pir_sealed *sealed) {
    if (sealed->upper)
        PIR_FREE(&sealed->allocator, sealed->upper, sealed->upper_size);
    if (sealed->kept)
        PIR_FREE(&sealed->allocator, sealed->kept, PIR_SEAL_KEPT + 1);
    if (sealed->descriptor >= 0)
        close(sealed->descriptor);
    *sealed = (pir_sealed){.descriptor = -1};
}

/* Reads a block at `at` and holds it against its hash. */
static bool read_block(pir_sealed *sealed, pir_sealed_block *block, uint64_t at, size_t size, const uint8_t *hash) {
    block->number = UINT64_MAX;
    if (!read_at(sealed->descriptor, block->bytes, size, at)) {
        sealed->error = errno;
        return false;
    }
    return has_hash(block->bytes, size, hash);
}

/* The block, checked, or NULL. */
static const pir_sealed_block *find_block(pir_sealed *sealed, uint64_t number) {
    pir_sealed_block *block = &sealed->kept[number % PIR_SEAL_KEPT], *hashes = &sealed->kept[PIR_SEAL_KEPT];
    if (block->number == number)
        return block;
    const uint64_t group = number / HASHES, bytes = blocks_of(sealed->size) * PIR_SEAL_HASH;
    bool good = hashes->number == group;
    if (!good) {
        const uint64_t at = sealed->size + group * PIR_SEAL_BLOCK;
        good = read_block(sealed, hashes, at, block_size(bytes, group), sealed->upper + group * PIR_SEAL_HASH);
        hashes->number = good ? group : UINT64_MAX;
    }
    good = good && read_block(sealed, block, number * PIR_SEAL_BLOCK, block_size(sealed->size, number),
                              hashes->bytes + number % HASHES * PIR_SEAL_HASH);
    if (!good) {
        sealed->damaged = number + 1;
        return NULL;
    }
    block->number = number;
    return block;
}

bool pir_sealed_read(pir_sealed *sealed, uint64_t at, size_t size, uint8_t *data) {
    while (size > 0 && at < sealed->size) {
        const uint64_t number = at / PIR_SEAL_BLOCK;
        const size_t from = (size_t)(at % PIR_SEAL_BLOCK), there = block_size(sealed->size, number) - from;
        const size_t taken = size < there ? size : there;
        const pir_sealed_block *block = find_block(sealed, number);
        if (!block)
            return false;
        memcpy(data, block->bytes + from, taken);
        data += taken;
        at += taken;
        size -= taken;
    }
    memset(data, 0, size);
    return true;
}

pir_status pir_sealed_tell(const pir_sealed *sealed, const char *path, pir_report *report) {
    if (sealed->damaged == 0)
        return PIR_OK;
    if (sealed->error)
        return pir_fail(report, PIR_ERR_FILE, "%s: cannot read: %s", path, strerror(sealed->error));
    const unsigned long long first = (sealed->damaged - 1) * PIR_SEAL_BLOCK;
    return pir_fail(report, PIR_ERR_FORMAT, "%s: damaged: bytes %llu to %llu are not those that were written", path,
                    first, first + block_size(sealed->size, sealed->damaged - 1) - 1);
}

pir_status pir_cspace_check(const char *path, const pir_allocator *allocator, pir_report *report) {
    if (!path)
        return pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file");
    pir_sealed sealed;
    pir_status status = pir_sealed_open(&sealed, path, allocator, report);
    for (uint64_t number = 0; status == PIR_OK && number < blocks_of(sealed.size); number++)
        if (!find_block(&sealed, number))
            status = pir_sealed_tell(&sealed, path, report);
    pir_sealed_close(&sealed);
    return status;
}

/* --- sealing --- */

/* A file under its seal: what is known of it. */
struct sealing {
    int descriptor;
    uint64_t size;
    uint8_t *upper;
    size_t upper_size;
    pir_sealed_block *block; /* two: one of the file, one of hashes */
};

/* The size of what is to be sealed: without the seal that is there. */
static bool find_size(struct sealing *s) {
    struct stat file;
    uint8_t end[END_SIZE];
    if (fstat(s->descriptor, &file) != 0)
        return false;
    s->size = (uint64_t)file.st_size;
    uint64_t whole = s->size, sealed;
    if (whole >= END_SIZE && read_at(s->descriptor, end, END_SIZE, whole - END_SIZE) && read_end(end, whole, &sealed))
        s->size = sealed;
    return true;
}

/* Writes the hashes of blocks, group by group, and takes those of them. */
static bool write_hashes(const struct sealing *s) {
    const uint64_t blocks = blocks_of(s->size);
    for (uint64_t group = 0; group * HASHES < blocks; group++) {
        size_t count = 0;
        for (uint64_t n = group * HASHES; n < blocks && count < HASHES; n++, count++) {
            const size_t size = block_size(s->size, n);
            if (!read_at(s->descriptor, s->block[0].bytes, size, n * PIR_SEAL_BLOCK))
                return false;
            hash_of(s->block[0].bytes, size, s->block[1].bytes + count * PIR_SEAL_HASH);
        }
        hash_of(s->block[1].bytes, count * PIR_SEAL_HASH, s->upper + group * PIR_SEAL_HASH);
        if (!write_at(s->descriptor, s->block[1].bytes, count * PIR_SEAL_HASH, s->size + group * PIR_SEAL_BLOCK))
            return false;
    }
    return true;
}

/* Writes the hashes of hashes and the end, which stand behind the hashes of blocks. */
static bool write_rest(const struct sealing *s) {
    const uint64_t at = s->size + blocks_of(s->size) * PIR_SEAL_HASH;
    uint8_t end[END_SIZE];
    write_end(s->size, s->upper, s->upper_size, end);
    return write_at(s->descriptor, s->upper, s->upper_size, at) &&
           write_at(s->descriptor, end, END_SIZE, at + s->upper_size) &&
           ftruncate(s->descriptor, (off_t)(at + s->upper_size + END_SIZE)) == 0 && fsync(s->descriptor) == 0;
}

pir_status pir_seal(const char *path, const pir_allocator *allocator, pir_report *report) {
    const pir_allocator a = pir_allocator_or_default(allocator);
    struct sealing s = {.descriptor = open(path, O_RDWR | O_CLOEXEC)};
    pir_status status = PIR_ERR_FILE;
    errno = s.descriptor < 0 ? errno : 0;
    if (s.descriptor >= 0 && find_size(&s)) {
        s.upper_size = (size_t)(blocks_of(blocks_of(s.size) * PIR_SEAL_HASH) * PIR_SEAL_HASH);
        s.upper = PIR_NEW(&a, uint8_t, s.upper_size);
        s.block = PIR_NEW(&a, pir_sealed_block, 2);
        if (!s.upper || !s.block)
            status = PIR_ERR_MEMORY;
        else if (write_hashes(&s) && write_rest(&s))
            status = PIR_OK;
    }
    const int error = errno;
    if (s.block)
        PIR_FREE(&a, s.block, 2);
    if (s.upper)
        PIR_FREE(&a, s.upper, s.upper_size);
    if (s.descriptor >= 0)
        close(s.descriptor);
    if (status == PIR_OK)
        return PIR_OK;
    return pir_fail(report, status, "%s: cannot seal: %s", path,
                    status == PIR_ERR_MEMORY ? "out of memory" : strerror(error));
}

pir_status pir_cspace_seal(const char *path, const pir_allocator *allocator, pir_report *report) {
    return path ? pir_seal(path, allocator, report) : pir_fail(report, PIR_ERR_ARGUMENT, "slices: no file");
}
