/* SPDX-License-Identifier: MIT */
/*
 * The updates of examples/game, of its very program: 300 hulls on a height field, a character, bullets, a sensor. Each
 * way of running it is a process of its own, and does the same some rounds. An update's time is the least of its
 * rounds, so that the slowest are those with most to do. scene_game.csv: threads, whether frames are guessed and taken
 * back, how many updates there are; mean, median, the 99th percentile and the most in microseconds.
 *
 *     bench_game FOLDER
 */
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <pirouette/scene.h>

#include "results.h"
#include "trial.h"

#define MOST   1000 /* updates */
#define ROUNDS 7

/* The times of updates: of a process's own, and the least of all rounds. */
static struct timed {
    uint32_t count;
    double update[MOST];
} timed, least;

/* As pir_scene_update, timed. */
static pir_status timed_update(pir_scene *scene, const pir_scene_move *moves, size_t count) {
    struct timespec from, to;
    clock_gettime(CLOCK_MONOTONIC, &from);
    const pir_status status = pir_scene_update(scene, moves, count);
    clock_gettime(CLOCK_MONOTONIC, &to);
    trial_need(timed.count < MOST ? PIR_OK : PIR_ERR_LIMIT, "updates");
    timed.update[timed.count++] = 1e9 * (double)(to.tv_sec - from.tv_sec) + (double)(to.tv_nsec - from.tv_nsec);
    return status;
}

static int game_main(int count, char **arguments);

#define main             game_main
#define pir_scene_update timed_update
#include <game.c>
#undef main
#undef pir_scene_update

static int compare_times(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Plays the game once, in a process of its own, since it ends with what it began. */
static void play(const char *threads, bool plain) {
    char name[] = "game", threads_now[8], word[] = "plain";
    char *arguments[] = {name, threads_now, plain ? word : NULL, NULL};
    int way[2];
    trial_need(pipe(way) == 0 ? PIR_OK : PIR_ERR_LIMIT, "a pipe");
    snprintf(threads_now, sizeof threads_now, "%s", threads);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        if (!freopen("/dev/null", "w", stdout) || game_main(plain ? 3 : 2, arguments) != EXIT_SUCCESS)
            _exit(1);
        _exit(write(way[1], &timed, sizeof timed) == (ssize_t)sizeof timed ? 0 : 1);
    }
    int status = 1;
    trial_need(child > 0 && waitpid(child, &status, 0) == child && status == 0 ? PIR_OK : PIR_ERR_LIMIT, "a game");
    struct timed its;
    trial_need(read(way[0], &its, sizeof its) == (ssize_t)sizeof its ? PIR_OK : PIR_ERR_LIMIT, "its times");
    close(way[0]);
    close(way[1]);
    for (uint32_t i = 0; i < its.count; i++)
        if (i >= least.count || its.update[i] < least.update[i])
            least.update[i] = its.update[i];
    least.count = its.count;
}

static void measure(const char *threads, bool plain, FILE *csv) {
    least.count = 0;
    for (uint32_t round = 0; round < results_count(ROUNDS); round++)
        play(threads, plain);
    const uint32_t count = least.count;
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += least.update[i];
    if (getenv("PIR_BENCH_FRAMES"))
        for (uint32_t i = 0; i < count; i++)
            printf("%u %.0f\n", i, least.update[i]);
    qsort(least.update, count, sizeof *least.update, compare_times);
    fprintf(csv, "%s,%s,%u,%.1f,%.1f,%.1f,%.1f\n", threads, plain ? "no" : "yes", (unsigned)count, sum / count / 1e3,
            least.update[count / 2] / 1e3, least.update[count - 1 - count / 100] / 1e3, least.update[count - 1] / 1e3);
    fflush(csv);
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: bench_game FOLDER\n");
        return 2;
    }
    const struct results results = results_new(argv[1]);
    FILE *csv = results_open(&results, "scene_game.csv");
    fprintf(csv, "threads,guesses,updates,mean_us,median_us,p99_us,most_us\n");
    measure("1", true, csv);
    measure("1", false, csv);
    measure("2", false, csv);
    results_close(csv, "scene_game.csv");
    return 0;
}
