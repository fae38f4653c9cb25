/* SPDX-License-Identifier: MIT */
/*
 * SIGINT, SIGTERM and SIGHUP. Each removes the temporary files and ends the process as the
 * signal does by itself. A long run can put that off, to end at a place of its own choice and report what it has
 * measured; a second signal is not put off.
 */
#ifndef TOOLS_INTERRUPT_H
#define TOOLS_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

/* Files that can be temporary at the same time. */
#define INTERRUPT_FILES 4

/* Watches for the signals, but for those that whoever started the process has it ignore. */
void interrupt_watch(void);

/* From here on the first signal only makes interrupt_asked true, or again ends the process. */
void interrupt_put_off(bool put_off);

/* Whether a signal has come while signals were put off. */
bool interrupt_asked(void);

/* Ends the process as the signal that was put off would have; returns when there was none. */
void interrupt_end(void);

/*
 * Creates the temporary file `path`, which must not exist and stays the caller's; a signal removes it until
 * interrupt_keep. Its descriptor, or -1 with errno set.
 */
int interrupt_create(char *path);

/* A signal no longer removes the file: it has its final name, or is gone. NULL is accepted. */
void interrupt_keep(const char *path);

#endif
