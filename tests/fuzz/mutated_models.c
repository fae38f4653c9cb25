/* SPDX-License-Identifier: MIT */
/*
 * Mutated model files through the command: mutated_models COUNT [MODEL.off...]
 *
 * COUNT files are made one after another from small shapes and the models named, in every format, and given to
 * `pirouette info --json`, which runs in a process of its own, forked from this one, where its main is called
 * command_main. Each run must end by itself within 2 s of CPU time and 1 GiB of memory, with status 0 and nothing on
 * stderr or with status 2 and one line there. PIR_TEST_SEED chooses the changes. A file that fails stays in the current
 * directory as mutated_SEED_NUMBER_PID.ENDING, which any other run of the same seed makes again.
 */
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <pirouette/pirouette.h>

#include "fuzz/input.h"
#include "fuzz/model_files.h"

#define CPU_SECONDS  2
#define WALL_SECONDS 60
#define MEMORY_KB    (1024l * 1024)
#define SEEDS_MAX    256
#define FAILURES_MAX 20

/* The main of the command. */
int command_main(int argc, char **argv);

struct seed {
    struct file_bytes file;
    const char *ending;
};

struct tally {
    unsigned long accepted, refused, failed;
    double seconds, longest; /* of CPU, of all runs and of one */
    long largest;            /* KB */
};

/* --- what to start from --- */

static size_t add_mesh(struct seed *seeds, size_t count, const pir_polytope *polytope) {
    pir_mesh *mesh = NULL;
    fuzz_require(pir_mesh_from_polytope(polytope, &mesh) == PIR_OK, "a polytope has a mesh");
    for (int form = 0; form < MODEL_FORM_COUNT && count < SEEDS_MAX; form++)
        seeds[count++] = (struct seed){model_file(mesh, (enum model_form)form), model_ending((enum model_form)form)};
    pir_mesh_destroy(mesh);
    return count;
}

static size_t make_seeds(struct seed *seeds, char **models, int model_count) {
    static const char *const shapes[] = {"tetrahedron", "cube", "dodecahedron", "box?x=1&y=2&z=0.001",
                                         "geodesic?level=2"};
    size_t count = 0;
    pir_report report = {0};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        pir_polytope *shape = NULL;
        fuzz_require(pir_shape_create(shapes[i], NULL, &report, &shape) == PIR_OK, report.text);
        count = add_mesh(seeds, count, shape);
        pir_polytope_release(shape);
    }
    for (int i = 0; i < model_count; i++) {
        pir_polytope *model = NULL;
        fuzz_require(pir_polytope_read(models[i], NULL, &report, NULL, &model) == PIR_OK, report.text);
        count = add_mesh(seeds, count, model);
        pir_polytope_release(model);
    }
    return count;
}

/* --- one run --- */

static void write_file(const char *path, const struct file_bytes *file) {
    FILE *stream = fopen(path, "wb");
    fuzz_require(stream != NULL, "the file can be written");
    size_t written = file->size > 0 ? fwrite(file->data, 1, file->size, stream) : 0;
    fuzz_require(fclose(stream) == 0 && written == file->size, "the file is written");
}

/* In the child: the command under its limits, stderr to `messages`. Never returns. */
static void become_command(const char *path, int messages) {
    char arguments[4][80] = {"pirouette", "info", "--json"};
    char *argv[] = {arguments[0], arguments[1], arguments[2], arguments[3], NULL};
    struct rlimit cpu = {CPU_SECONDS, CPU_SECONDS + 1}, core = {0, 0};
    int nothing = open("/dev/null", O_RDWR);
    snprintf(arguments[3], sizeof arguments[3], "%s", path);
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_CORE, &core);
    alarm(WALL_SECONDS);
    dup2(nothing, STDIN_FILENO);
    dup2(nothing, STDOUT_FILENO);
    dup2(messages, STDERR_FILENO);
    int status = command_main(4, argv);
    fflush(NULL);
    _exit(status);
}

/* What is wrong with how the run ended, or NULL. */
static const char *judge(int status, const char *message, struct tally *tally) {
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    double all = (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                 (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) / 1e6;
    double seconds = all - tally->seconds;
    tally->seconds = all;
    tally->longest = seconds > tally->longest ? seconds : tally->longest;
    tally->largest = usage.ru_maxrss;
    if (WIFSIGNALED(status))
        return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGALRM ? "it does not end"
                                                                          : strsignal(WTERMSIG(status));
    if (usage.ru_maxrss > MEMORY_KB)
        return "it takes more than 1 GiB of memory";
    const char *end = strchr(message, '\n');
    switch (WEXITSTATUS(status)) {
    case 0:
        tally->accepted++;
        return message[0] == '\0' ? NULL : "it succeeds and complains";
    case 2:
        tally->refused++;
        return strncmp(message, "pirouette: ", 11) == 0 && end && end[1] == '\0' ? NULL
                                                                                 : "its complaint is not one line";
    default:
        return "its status is neither 0 nor 2";
    }
}

/* Runs the command on one file; false when it fails. */
static int run_file(const char *path, struct tally *tally) {
    int ends[2], status;
    char message[8192];
    size_t length = 0;
    fuzz_require(pipe(ends) == 0, "a pipe can be made");
    fflush(stdout); // or the child would print it again
    pid_t child = fork();
    fuzz_require(child >= 0, "a process can be made");
    if (child == 0)
        become_command(path, ends[1]);
    close(ends[1]);
    for (ssize_t got = 1; got > 0;) {
        char rest[512];
        int full = length + 1 == sizeof message;
        got = read(ends[0], full ? rest : message + length, full ? sizeof rest : sizeof message - 1 - length);
        length += full || got < 0 ? 0 : (size_t)got;
    }
    message[length] = '\0';
    close(ends[0]);
    fuzz_require(waitpid(child, &status, 0) == child, "the process is waited for");
    const char *wrong = judge(status, message, tally);
    if (wrong)
        printf("%s: %s\n%s", path, wrong, message);
    return wrong == NULL;
}

int main(int argc, char **argv) {
    fuzz_require(argc >= 2, "usage: mutated_models COUNT [MODEL.off...]");
    static struct seed seeds[SEEDS_MAX];
    size_t seed_count = make_seeds(seeds, argv + 2, argc - 2);
    unsigned long count = strtoul(argv[1], NULL, 10);
    struct tally tally = {0};
    test_print_seed();
    for (unsigned long i = 0; i < count && tally.failed < FAILURES_MAX; i++) {
        test_random random = test_random_case("mutated models", i);
        const struct seed *seed = &seeds[test_random_below(&random, (uint32_t)seed_count)];
        struct file_bytes file = file_copy(&seed->file);
        mutate_file(&random, &file, &seeds[test_random_below(&random, (uint32_t)seed_count)].file);
        char path[80];
        snprintf(path, sizeof path, "mutated_%" PRIu64 "_%lu_%ld.%s", test_seed(), i, (long)getpid(), seed->ending);
        write_file(path, &file);
        if (run_file(path, &tally))
            remove(path);
        else
            tally.failed++;
        free(file.data);
    }
    for (size_t i = 0; i < seed_count; i++)
        free(seeds[i].file.data);
    printf("%lu accepted, %lu refused, %lu failed; at most %.2f s of CPU and %ld KB\n", tally.accepted, tally.refused,
           tally.failed, tally.longest, tally.largest);
    return tally.failed > 0 || tally.accepted == 0 || tally.refused == 0;
}
