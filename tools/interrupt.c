/* SPDX-License-Identifier: MIT */
/* Signals and temporary files; see interrupt.h. The handler calls only functions that POSIX lists as safe there. */
#include "interrupt.h"

#include <assert.h>
#include <fcntl.h>
#include <stddef.h>
#include <unistd.h>

static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
#define NUMBER_COUNT (sizeof numbers / sizeof *numbers)

static volatile sig_atomic_t is_put_off, asked;
static char *volatile temporaries[INTERRUPT_FILES];

static void on_signal(int number) {
    if (is_put_off && !asked) {
        asked = number;
        return;
    }
    for (size_t i = 0; i < INTERRUPT_FILES; i++)
        if (temporaries[i])
            unlink(temporaries[i]);
    // the signal is blocked in its handler, and ends the process when that returns
    signal(number, SIG_DFL);
    raise(number);
}

void interrupt_watch(void) {
    for (size_t i = 0; i < NUMBER_COUNT; i++) {
        struct sigaction old, action = {.sa_handler = on_signal};
        sigemptyset(&action.sa_mask);
        if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, NULL);
    }
}

void interrupt_put_off(bool put_off) {
    is_put_off = put_off;
}

bool interrupt_asked(void) {
    return asked != 0;
}

void interrupt_end(void) {
    if (!asked)
        return;
    signal(asked, SIG_DFL);
    raise(asked);
}

/* Holds the signals back while the list of files and what is on the disk do not agree. */
static void hold(sigset_t *ret_before) {
    sigset_t all;
    sigemptyset(&all);
    for (size_t i = 0; i < NUMBER_COUNT; i++)
        sigaddset(&all, numbers[i]);
    sigprocmask(SIG_BLOCK, &all, ret_before);
}

int interrupt_create(char *path) {
    sigset_t before;
    hold(&before);
    int descriptor = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    size_t i = 0;
    while (i + 1 < INTERRUPT_FILES && temporaries[i])
        i++;
    assert(!temporaries[i]);
    if (descriptor >= 0)
        temporaries[i] = path;
    sigprocmask(SIG_SETMASK, &before, NULL);
    return descriptor;
}

void interrupt_keep(const char *path) {
    for (size_t i = 0; path && i < INTERRUPT_FILES; i++)
        if (temporaries[i] == path)
            temporaries[i] = NULL;
}
