/* SPDX-License-Identifier: MIT */
/* See block_journal.h. */
#include "plan/blocks/block_journal.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/report.h"
#include "polytope/file/file_name.h"
#include "polytope/file/file_places.h"

#define MAGIC      UINT64_C(0x31304e414c505249) /* "IRPLAN01" */
#define SYNC_EVERY 2                            /* seconds between the moments when bytes are made to reach the disk */

struct journal_header {
    uint64_t magic, question;
};

struct block_header {
    uint64_t number, size, hash;
};

/* Where a block stands. */
struct block_place {
    uint64_t number, at;
};

struct pir_block_journal {
    int descriptor;
    char *path;
    pir_report *report;
    uint64_t end; /* of what is whole */
    struct block_place *place;
    size_t places, room;
    time_t synced;
    pthread_mutex_t lock;
};

static uint64_t hash_of(const struct block_header *header, uint64_t at, const uint8_t *data) {
    const uint64_t before[3] = {header->number, header->size, at};
    return pir_hash_words(pir_hash_words(PIR_HASH_START, before, sizeof before), data, header->size);
}

static pir_status fail(const pir_block_journal *journal, const char *what) {
    return pir_fail(journal->report, PIR_ERR_FILE, "%s: cannot %s: %s", pir_short_name(journal->path), what,
                    strerror(errno));
}

/* --- what is there --- */

/* Reads the block at a place and its header: PIR_ERR_FORMAT where none is whole. */
static pir_status read_block(const pir_block_journal *journal, uint64_t at, uint64_t end, struct block_header *header,
                             pir_bytes *block) {
    const pir_allocator a = pir_allocator_or_default(NULL);
    block->used = 0;
    if (at + sizeof *header > end || pir_read_at(journal->descriptor, header, sizeof *header, at) != PIR_OK ||
        header->size > end - at - sizeof *header)
        return PIR_ERR_FORMAT;
    if (!pir_bytes_reserve(block, &a, header->size))
        return PIR_ERR_MEMORY;
    block->used = header->size;
    const bool is_whole = pir_read_at(journal->descriptor, block->data, header->size, at + sizeof *header) == PIR_OK &&
                          header->hash == hash_of(header, at, block->data);
    return is_whole ? PIR_OK : PIR_ERR_FORMAT;
}

static bool note(pir_block_journal *journal, uint64_t number, uint64_t at) {
    if (journal->places == journal->room) {
        const size_t room = 2 * journal->room + 64;
        struct block_place *grown = realloc(journal->place, room * sizeof *grown);
        if (!grown)
            return false;
        journal->place = grown;
        journal->room = room;
    }
    journal->place[journal->places++] = (struct block_place){number, at};
    return true;
}

static int compare(const void *a, const void *b) {
    const uint64_t x = ((const struct block_place *)a)->number, y = ((const struct block_place *)b)->number;
    return x < y ? -1 : x > y;
}

/* Notes the blocks of the file, and cuts off what follows them. */
static pir_status scan(pir_block_journal *journal, uint64_t size) {
    const pir_allocator a = pir_allocator_or_default(NULL);
    struct block_header header;
    pir_bytes block = {0};
    pir_status status;
    while ((status = read_block(journal, journal->end, size, &header, &block)) == PIR_OK) {
        if (!note(journal, header.number, journal->end)) {
            status = PIR_ERR_MEMORY;
            break;
        }
        journal->end += sizeof header + header.size;
    }
    pir_bytes_finish(&block, &a);
    // blocks that were not read may be whole
    if (status == PIR_ERR_MEMORY)
        return pir_fail(journal->report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(journal->path));
    if (journal->places > 0)
        qsort(journal->place, journal->places, sizeof *journal->place, compare);
    return ftruncate(journal->descriptor, (off_t)journal->end) == 0 ? PIR_OK : fail(journal, "cut");
}

bool pir_block_journal_find(const pir_block_journal *journal, uint64_t number, pir_bytes *ret_block) {
    const struct block_place key = {number, 0}, *place = NULL;
    struct block_header header;
    if (journal->places > 0)
        place = bsearch(&key, journal->place, journal->places, sizeof key, compare);
    return place && read_block(journal, place->at, journal->end, &header, ret_block) == PIR_OK &&
           header.number == number;
}

/* --- beginning and end --- */

/* Whether the path leads to the file that is open: the run before may have removed it. */
static bool is_there(const pir_block_journal *journal) {
    struct stat named, opened;
    return stat(journal->path, &named) == 0 && fstat(journal->descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

/* Reads the header of the file, or writes it where there is none that is whole. */
static pir_status begin(pir_block_journal *journal, uint64_t question, bool resume) {
    struct journal_header header = {MAGIC, question}, found;
    struct stat file;
    if (flock(journal->descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return pir_fail(journal->report, PIR_ERR_FILE, "%s: another process is writing to it",
                        pir_short_name(journal->path));
    if (fstat(journal->descriptor, &file) != 0)
        return fail(journal, "read");
    journal->end = sizeof header;
    if (resume && pir_read_at(journal->descriptor, &found, sizeof found, 0) == PIR_OK) {
        if (memcmp(&found, &header, sizeof found) != 0)
            return pir_fail(journal->report, PIR_ERR_FORMAT, "%s: it is of another question, or of another version",
                            pir_short_name(journal->path));
        return scan(journal, (uint64_t)file.st_size);
    }
    if (ftruncate(journal->descriptor, 0) != 0 || !pir_write_at(journal->descriptor, &header, sizeof header, 0))
        return fail(journal, "write");
    return PIR_OK;
}

pir_status pir_block_journal_open(const char *path, uint64_t question, bool resume, pir_report *report,
                                  pir_block_journal **ret_journal) {
    pir_block_journal *journal = calloc(1, sizeof *journal);
    pir_status status = PIR_OK;
    if (journal)
        journal->path = strdup(path);
    if (!journal || !journal->path || pthread_mutex_init(&journal->lock, NULL) != 0) {
        if (journal)
            free(journal->path);
        free(journal);
        return pir_fail(report, PIR_ERR_MEMORY, "%s: out of memory", pir_short_name(path));
    }
    journal->report = report;
    do {
        journal->descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (journal->descriptor < 0)
            status = fail(journal, "write");
        else
            status = begin(journal, question, resume);
        if (status != PIR_OK || is_there(journal))
            break;
        close(journal->descriptor);
        journal->places = 0;
    } while (true);
    if (status == PIR_OK)
        *ret_journal = journal;
    else
        pir_block_journal_close(journal, false);
    return status;
}

pir_status pir_block_journal_add(pir_block_journal *journal, uint64_t number, const pir_bytes *block) {
    struct block_header header = {number, block->used, 0};
    struct timespec now;
    pthread_mutex_lock(&journal->lock);
    header.hash = hash_of(&header, journal->end, block->data);
    bool good = pir_write_at(journal->descriptor, &header, sizeof header, journal->end) &&
                pir_write_at(journal->descriptor, block->data, block->used, journal->end + sizeof header);
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (good && now.tv_sec - journal->synced > SYNC_EVERY) {
        good = fdatasync(journal->descriptor) == 0;
        journal->synced = now.tv_sec;
    }
    pir_status status = PIR_OK;
    if (good)
        journal->end += sizeof header + block->used;
    else
        status = fail(journal, "write");
    pthread_mutex_unlock(&journal->lock);
    return status;
}

void pir_block_journal_close(pir_block_journal *journal, bool is_done) {
    if (!journal)
        return;
    // removed while it is locked, so that no other process takes a file that is gone
    if (is_done)
        unlink(journal->path);
    if (journal->descriptor >= 0)
        close(journal->descriptor);
    pthread_mutex_destroy(&journal->lock);
    free(journal->place);
    free(journal->path);
    free(journal);
}
