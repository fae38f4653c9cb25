/* SPDX-License-Identifier: MIT */
/* What every test includes: cmocka with the headers it needs before it, and an assertion that tells the case. */
#ifndef PIR_TEST_TEST_H
#define PIR_TEST_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

/* What a program of tests ends with that has nothing to do on this machine: meson shows it as SKIP. */
#define TEST_SKIPPED 77

/* Fails the test with the printf-formatted text, which should say how to find the case again,
   unless the condition holds. */
#define expect(condition, ...)                                                                                         \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            print_error(__VA_ARGS__);                                                                                  \
            fail_msg(": %s does not hold", #condition);                                                                \
        }                                                                                                              \
    } while (0)

#endif
