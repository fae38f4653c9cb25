/* SPDX-License-Identifier: MIT */
/*
 * Blocks of bytes in a file that only grows, each under a number.
 *
 * Invariant: the file is a header, with a hash of the question, and whole blocks, each with a hash of its number, its
 * place and its bytes. A process that is killed leaves at most one block that is not whole, at the end. So reading
 * stops at the first block whose hash does not match, and what follows is cut off.
 *
 * Hashes tell damage, not forgery: whoever takes a block has to hold for possible that it says anything. Numbers are in
 * the machine's own order.
 */
#ifndef PIR_PLAN_BLOCK_JOURNAL_H
#define PIR_PLAN_BLOCK_JOURNAL_H

#include "base/byte_block.h"

typedef struct pir_block_journal pir_block_journal;

/*
 * Opens the journal of a question at a path, which one process does at a time. With `resume` the blocks in it are
 * there; else it begins anew. `report` is filled by later failures too. Errors: PIR_ERR_FILE, PIR_ERR_FORMAT (the
 * journal of another question, or none), PIR_ERR_MEMORY.
 */
pir_status pir_block_journal_open(const char *path, uint64_t question, bool resume, pir_report *report,
                                  pir_block_journal **ret_journal);

/* The block of a number that was there when the journal was opened; false where none is, or it cannot be read. */
bool pir_block_journal_find(const pir_block_journal *journal, uint64_t number, pir_bytes *ret_block);

/* Adds a block, from any thread. Errors: PIR_ERR_FILE. */
pir_status pir_block_journal_add(pir_block_journal *journal, uint64_t number, const pir_bytes *block);

/* Closes the journal, and removes the file where it is of no more use. NULL is accepted. */
void pir_block_journal_close(pir_block_journal *journal, bool is_done);

#endif
