/* SPDX-License-Identifier: MIT */
/* Reading arguments by a command's table of options; the rules stand in args.h. */
#include "args.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

/* The longest number text that is copied out of a list. */
#define NUMBER_LENGTH 128

/* The row of the option that `text` names, up to its end or an equals sign; -1 when there is none. */
static int find_option(const struct command *command, const char *text) {
    size_t length = strcspn(text, "=");
    for (int i = 0; command->options[i].name; i++)
        if (option_is(&command->options[i], text, length))
            return i;
    return -1;
}

/* Takes the option at argv[*at], and the value after it. */
static bool take_option(struct args *args, int argc, char *const *argv, int *at) {
    const char *text = argv[*at], *equals = strchr(text, '='), *name = args->command->name;
    int row = find_option(args->command, text);
    if (row < 0) {
        complain("%s: unknown option '%s'; see pirouette %s --help", name, text, name);
        return false;
    }
    const struct option *option = &args->command->options[row];
    if (args->value[row]) {
        complain("%s: %s is given twice", name, option->name);
        return false;
    }
    if (!option->value) {
        if (equals) {
            complain("%s: %.*s takes no value, but is given '%s'", name, (int)(equals - text), text, equals + 1);
            return false;
        }
        args->value[row] = "";
        args->help = option_is(option, "--help", strlen("--help"));
        return true;
    }
    if (!equals && *at + 1 >= argc) {
        complain("%s: %s has no value; it takes %s", name, option->name, option->value);
        return false;
    }
    args->value[row] = equals ? equals + 1 : argv[++*at];
    return true;
}

static bool take_positional(struct args *args, const char *text) {
    const char *const *names = args->command->positional;
    size_t last = 0;
    while (names[last] && names[last + 1])
        last++;
    bool repeats = names[last] && positional_repeats(names[last]) && args->positional_count > last;
    if (args->positional_count == ARGS_POSITIONAL_MAX || (!repeats && !names[args->positional_count])) {
        complain("%s: '%s' is one argument too many", args->command->name, text);
        return false;
    }
    args->positional[args->positional_count++] = text;
    return true;
}

bool args_parse(const struct command *command, int argc, char *const *argv, struct args *args) {
    *args = (struct args){.command = command};
    bool options = true;
    for (int i = 0; i < argc && !args->help; i++) {
        const char *text = argv[i];
        bool taken = true;
        if (options && strcmp(text, "--") == 0)
            options = false;
        else if (options && text[0] == '-' && text[1] != '\0')
            taken = take_option(args, argc, argv, &i);
        else
            taken = take_positional(args, text);
        if (!taken)
            return false;
    }
    if (!args->help && args->positional_count < command->required) {
        complain("%s: %s is missing; see pirouette %s --help", command->name,
                 command->positional[args->positional_count], command->name);
        return false;
    }
    return true;
}

const char *args_value(const struct args *args, const char *name) {
    int row = find_option(args->command, name);
    assert(row >= 0 && row < ARGS_OPTIONS_MAX);
    return args->value[row];
}

bool args_has(const struct args *args, const char *name) {
    return args_value(args, name) != NULL;
}

bool args_count(const struct args *args, const char *name, uint64_t least, uint64_t most, uint64_t *number) {
    const char *text = args_value(args, name);
    if (!text)
        return true;
    // digits only: strtoull would also take blanks and a minus sign
    size_t digits = strspn(text, "0123456789");
    errno = 0;
    uint64_t value = strtoull(text, NULL, 10);
    if (digits == 0 || text[digits] != '\0') {
        complain("%s: %s: '%s' is not a whole number", args->command->name, name, text);
        return false;
    }
    if (errno == ERANGE || value < least || value > most) {
        complain("%s: %s: %s is not between %" PRIu64 " and %" PRIu64, args->command->name, name, text, least, most);
        return false;
    }
    *number = value;
    return true;
}

/* A finite number that takes up the whole of `text`; `place` says which of several it is, or is empty. */
static bool read_number(const struct args *args, const char *name, const char *place, const char *text,
                        double *ret_number) {
    char *end;
    double value = strtod(text, &end);
    bool is_number = end != text && *end == '\0' && !isspace((unsigned char)text[0]);
    if (is_number && isfinite(value)) {
        *ret_number = value;
        return true;
    }
    complain("%s: %s: %s'%s' is not %s", args->command->name, name, place, text, is_number ? "finite" : "a number");
    return false;
}

bool args_numbers(const struct args *args, const char *name, size_t count, double *numbers) {
    const char *text = args_value(args, name);
    if (!text)
        return true;
    size_t given = 1;
    for (const char *c = text; *c; c++)
        given += *c == ',';
    if (given != count) {
        complain("%s: %s: '%s' is %zu number%s, not %zu", args->command->name, name, text, given, given == 1 ? "" : "s",
                 count);
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        size_t length = strcspn(text, ",");
        char part[NUMBER_LENGTH], place[64] = "";
        if (count > 1)
            snprintf(place, sizeof place, "number %zu of %zu, ", i + 1, count);
        if (length >= sizeof part) {
            complain("%s: %s: %sof more than %d characters", args->command->name, name, count > 1 ? place : "a number ",
                     NUMBER_LENGTH - 1);
            return false;
        }
        memcpy(part, text, length);
        part[length] = '\0';
        if (!read_number(args, name, place, part, &numbers[i]))
            return false;
        text += length + 1;
    }
    return true;
}

bool args_choice(const struct args *args, const char *name, const char *const *choices, int *choice) {
    const char *text = args_value(args, name);
    if (!text)
        return true;
    char list[128] = "";
    for (int i = 0; choices[i]; i++) {
        if (strcmp(choices[i], text) == 0) {
            *choice = i;
            return true;
        }
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", choices[i]);
    }
    complain("%s: %s: '%s' is none of %s", args->command->name, name, text, list);
    return false;
}
