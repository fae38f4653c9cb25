/* SPDX-License-Identifier: MIT */
/*
 * A rank asks rank 0 with two numbers, what it wants and the unit that it has done, and gets one.
 *
 *     CLAIM   a unit that no one has, or NONE; asked for ahead, while the unit before is made
 *     NOTE    no answer: only the unit that is done
 *     REST    a late unit, once there is one; ENDED when all are done, or when rank 0 has failed
 *     FAILED  no answer: the rank has ended, by an error or a signal, and its unit is lost
 *
 * On rank 0 one thread answers while another makes units. Messages are few, two a unit, so it looks for them and sleeps
 * in between, the longer the longer none has come: units are asked for ahead, so an answer that takes half as long as a
 * unit holds no one up. A thread tells that its unit is done when it claims the next one.
 */
#include "ranks.h"

#include <stdlib.h>

#include "../launched.h"
#include "../message.h"

#if PIR_HAVE_MPI

#include <limits.h>
#include <mpi.h>
#include <pthread.h>
#include <time.h>

#include "../interrupt.h"

enum want { WANT_CLAIM, WANT_NOTE, WANT_REST, WANT_FAILED };

#define NONE  UINT64_MAX
#define ENDED (UINT64_MAX - 1)

/* A unit that is done sooner than this was found made already, by an earlier run. */
#define FOUND_SECONDS 2e-4

/* For how long, in nanoseconds, the thread that answers sleeps at least and at most. */
#define NAP_LEAST 100000
#define NAP_MOST  5000000

/* Tags of messages. */
#define TAG_ASK    1
#define TAG_ANSWER 2

struct ranks_shared {
    pthread_mutex_t lock;
    struct dealer dealer; /* of rank 0 */
    bool stopped;         /* rank 0 has failed */
    bool own_ended;       /* the thread of rank 0 that makes units */
    bool *resting, *told; /* per rank: waits for an answer; has been told the end */
    uint64_t *holds;      /* per rank: the last unit that it was given, or NONE */
    pir_cspace_job *job;
    pir_report report;
    pir_status status;
};

/* The unit that this thread makes. */
static _Thread_local uint64_t in_work = NONE;
static _Thread_local double in_work_since;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec / 1e9;
}

static void nap(long nanoseconds) {
    nanosleep(&(struct timespec){0, nanoseconds}, NULL);
}

/* --- rank 0 --- */

static bool is_over(const struct ranks_shared *shared) {
    return shared->stopped || shared->dealer.done == shared->dealer.units;
}

/* The unit for a rank that wants one, or NONE. The lock is held. */
static uint64_t deal(struct ranks_shared *shared) {
    uint64_t unit = is_over(shared) ? shared->dealer.units : dealer_deal(&shared->dealer, now());
    return unit < shared->dealer.units ? unit : NONE;
}

/* The unit for a rank that rests, NONE for nothing yet, or ENDED. The lock is held. */
static uint64_t deal_late(struct ranks_shared *shared) {
    if (is_over(shared))
        return ENDED;
    uint64_t unit = dealer_late(&shared->dealer, now());
    return unit < shared->dealer.units ? unit : NONE;
}

static void answer(struct ranks_shared *shared, int rank, uint64_t unit) {
    MPI_Send(&unit, 1, MPI_UINT64_T, rank, TAG_ANSWER, MPI_COMM_WORLD);
    shared->resting[rank] = false;
    if (unit == ENDED)
        shared->told[rank] = true;
    else
        shared->holds[rank] = unit;
}

/* Whether the unit took time; the two numbers come with each question. */
static void note_done(struct ranks_shared *shared, uint64_t unit, uint64_t is_new) {
    if (unit != NONE)
        dealer_done(&shared->dealer, unit, is_new != 0, now());
}

/* Answers all that ask; whether any did. The lock is held. */
static bool serve(const struct ranks *ranks) {
    struct ranks_shared *shared = ranks->shared;
    MPI_Status from;
    bool any = false;
    for (int there = 1; there; any |= there) {
        MPI_Iprobe(MPI_ANY_SOURCE, TAG_ASK, MPI_COMM_WORLD, &there, &from);
        if (!there)
            break;
        uint64_t ask[3];
        int rank = from.MPI_SOURCE;
        MPI_Recv(ask, 3, MPI_UINT64_T, rank, TAG_ASK, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
        note_done(shared, ask[1], ask[2]);
        if (ask[0] == WANT_CLAIM)
            answer(shared, rank, deal(shared));
        else if (ask[0] == WANT_REST)
            shared->resting[rank] = true;
        else if (ask[0] == WANT_FAILED)
            shared->told[rank] = true;
        if (ask[0] == WANT_FAILED && shared->holds[rank] != NONE)
            dealer_lost(&shared->dealer, shared->holds[rank]);
    }
    for (int rank = 1; rank < (int)ranks->count; rank++) {
        uint64_t unit = shared->resting[rank] ? deal_late(shared) : NONE;
        if (unit != NONE)
            answer(shared, rank, unit);
    }
    return any;
}

/* --- any rank --- */

/* Whether this process has asked for a unit ahead. The library claims one at a time. */
static bool asked_ahead;

static void send_question(enum want want) {
    const uint64_t question[3] = {want, want == WANT_CLAIM ? NONE : in_work, now() - in_work_since > FOUND_SECONDS};
    MPI_Send(question, 3, MPI_UINT64_T, 0, TAG_ASK, MPI_COMM_WORLD);
}

static uint64_t receive_answer(void) {
    uint64_t unit = NONE;
    MPI_Recv(&unit, 1, MPI_UINT64_T, 0, TAG_ANSWER, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    return unit;
}

/* A unit for another rank than 0, which was asked for ahead; the next one is asked for. */
static uint64_t claim_ahead(void) {
    if (in_work != NONE)
        send_question(WANT_NOTE);
    if (!asked_ahead)
        send_question(WANT_CLAIM);
    uint64_t unit = receive_answer();
    asked_ahead = unit != NONE;
    if (asked_ahead)
        send_question(WANT_CLAIM);
    return unit;
}

/* Asks rank 0 for rest, or tells it of a failure, from another rank. */
static uint64_t ask(enum want want) {
    if (asked_ahead)
        receive_answer(); // of a run that was ended; rank 0 knows what this rank holds
    asked_ahead = false;
    send_question(want);
    if (want == WANT_FAILED)
        return ENDED;
    for (int there = 0; !there; nap(500000))
        MPI_Iprobe(0, TAG_ANSWER, MPI_COMM_WORLD, &there, MPI_STATUS_IGNORE);
    return receive_answer();
}

/* A unit for rank 0 itself, which tells the dealer without a message that the one before is done. */
static uint64_t claim_own(struct ranks_shared *shared) {
    pthread_mutex_lock(&shared->lock);
    note_done(shared, in_work, now() - in_work_since > FOUND_SECONDS);
    uint64_t unit = deal(shared);
    pthread_mutex_unlock(&shared->lock);
    return unit;
}

static uint64_t rest_own(struct ranks_shared *shared) {
    uint64_t unit = NONE;
    for (bool first = true; unit == NONE; first = false) {
        if (!first)
            nap(500000);
        pthread_mutex_lock(&shared->lock);
        unit = interrupt_asked() ? ENDED : deal_late(shared);
        pthread_mutex_unlock(&shared->lock);
    }
    return unit;
}

/* A late unit that the next claim of this process gives. */
static uint64_t handed = NONE;

uint64_t ranks_next(const struct ranks *ranks) {
    uint64_t unit = handed;
    handed = NONE;
    if (unit == NONE)
        unit = ranks->number > 0 ? claim_ahead() : claim_own(ranks->shared);
    in_work = unit;
    in_work_since = now();
    return unit;
}

/* Makes units until all are done. */
static void work(const struct ranks *ranks) {
    struct ranks_shared *shared = ranks->shared;
    do {
        shared->status = pir_cspace_job_run(shared->job, &shared->report);
        if (shared->status != PIR_OK || interrupt_asked()) {
            in_work = NONE;
            if (ranks->number > 0)
                ask(WANT_FAILED);
            return;
        }
        handed = ranks->number > 0 ? ask(WANT_REST) : rest_own(shared);
        in_work = NONE;
    } while (handed != ENDED);
}

static void *work_beside(void *context) {
    const struct ranks *ranks = context;
    work(ranks);
    pthread_mutex_lock(&ranks->shared->lock);
    ranks->shared->own_ended = true;
    ranks->shared->stopped |= ranks->shared->status != PIR_OK || interrupt_asked();
    pthread_mutex_unlock(&ranks->shared->lock);
    return NULL;
}

/* Serves until the own thread has ended, or, with `all`, until all ranks have been told the end. */
static void serve_until(const struct ranks *ranks, bool all) {
    long wait = NAP_LEAST;
    for (bool ended = false; !ended; nap(wait)) {
        pthread_mutex_lock(&ranks->shared->lock);
        const bool any = serve(ranks);
        wait = any ? NAP_LEAST : 2 * wait < NAP_MOST ? 2 * wait : NAP_MOST;
        ended = ranks->shared->own_ended;
        for (uint32_t rank = 1; all && rank < ranks->count; rank++)
            ended &= ranks->shared->told[rank];
        pthread_mutex_unlock(&ranks->shared->lock);
    }
}

pir_status ranks_run(struct ranks *ranks, pir_cspace_job *job, uint64_t pairs, pir_report *report) {
    struct ranks_shared *shared = ranks->shared;
    if (ranks->count == 1)
        return pir_cspace_job_run(job, report);
    shared->job = job;
    handed = in_work = NONE;
    asked_ahead = false;
    if (ranks->number > 0) {
        work(ranks);
    } else {
        pthread_t thread;
        if (!dealer_init(&shared->dealer, pir_cspace_job_units(job), pairs) ||
            pthread_create(&thread, NULL, work_beside, ranks) != 0) {
            shared->stopped = shared->own_ended = true;
            return PIR_ERR_MEMORY;
        }
        serve_until(ranks, false);
        pthread_join(thread, NULL);
    }
    if (report)
        *report = shared->report;
    return shared->status;
}

/* The bytes that all have given last, and how many each gives. */
static char *given;
static int *counts, *places;

/* Bytes of this process go to all; MPI counts them in ints. */
bool ranks_exchange(void *context, const void *own, size_t size, void **ret_all, size_t *ret_size) {
    const struct ranks *ranks = context;
    int mine = size < INT_MAX ? (int)size : -1;
    size_t all = 0;
    counts = counts ? counts : calloc(ranks->count, sizeof *counts);
    places = places ? places : calloc(ranks->count, sizeof *places);
    if (!ranks_agree(ranks, counts && places && mine >= 0))
        return false;
    MPI_Allgather(&mine, 1, MPI_INT, counts, 1, MPI_INT, MPI_COMM_WORLD);
    for (uint32_t rank = 0; rank < ranks->count; rank++) {
        places[rank] = (int)(all < INT_MAX ? all : INT_MAX);
        all += (size_t)counts[rank];
    }
    free(given);
    given = malloc(all + 1);
    if (!ranks_agree(ranks, given && all < INT_MAX))
        return false;
    MPI_Allgatherv(own, mine, MPI_BYTE, given, counts, places, MPI_BYTE, MPI_COMM_WORLD);
    *ret_all = given;
    *ret_size = all;
    return true;
}

void ranks_stop(const struct ranks *ranks) {
    if (ranks->count > 1)
        MPI_Abort(MPI_COMM_WORLD, 2);
}

uint64_t ranks_done(const struct ranks *ranks) {
    return ranks->shared ? ranks->shared->dealer.done : 0;
}

/* --- beginning and end --- */

static bool make_shared(struct ranks *ranks) {
    struct ranks_shared *shared = calloc(1, sizeof *shared);
    ranks->shared = shared;
    if (!shared)
        return false;
    shared->resting = calloc(ranks->count, sizeof *shared->resting);
    shared->told = calloc(ranks->count, sizeof *shared->told);
    shared->holds = malloc(ranks->count * sizeof *shared->holds);
    for (uint32_t rank = 0; shared->holds && rank < ranks->count; rank++)
        shared->holds[rank] = NONE;
    return shared->resting && shared->told && shared->holds && pthread_mutex_init(&shared->lock, NULL) == 0;
}

bool ranks_begin(struct ranks *ranks) {
    *ranks = (struct ranks){0, 1, NULL};
    if (!launched_by_mpi())
        return true;
    int level = MPI_THREAD_SINGLE, number = 0, count = 1;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &level);
    MPI_Comm_rank(MPI_COMM_WORLD, &number);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    ranks->number = (uint32_t)number;
    ranks->count = (uint32_t)count;
    if (ranks_agree(ranks, level >= MPI_THREAD_SERIALIZED && (count == 1 || make_shared(ranks))))
        return true;
    complain("MPI serves one thread alone, or memory ran out");
    return false;
}

bool ranks_agree(const struct ranks *ranks, bool good) {
    int own = good, all = good;
    if (ranks->count > 1)
        MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return all != 0;
}

void ranks_end(struct ranks *ranks) {
    struct ranks_shared *shared = ranks->shared;
    int launched = 0;
    if (shared && ranks->number == 0 && shared->job)
        serve_until(ranks, true);
    if (shared) {
        pthread_mutex_destroy(&shared->lock);
        dealer_finish(&shared->dealer);
        free(shared->resting);
        free(shared->told);
        free(shared->holds);
        free(shared);
    }
    free(given);
    free(counts);
    free(places);
    given = NULL;
    counts = places = NULL;
    *ranks = (struct ranks){0, 1, NULL};
    MPI_Initialized(&launched);
    if (launched)
        MPI_Finalize();
}

#else

/*
 * Whether a launcher of MPI has started this process as one of several: its variable, which says how many there are, or
 * which of them this is.
 */
static const char *launched_as_one_of_several(void) {
    static const char *const counts[] = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE"};
    static const char *const numbers[] = {"PMI_RANK", "PMIX_RANK"};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        if (getenv(counts[i]) && strtol(getenv(counts[i]), NULL, 10) > 1)
            return counts[i];
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (getenv(numbers[i]) && strtol(getenv(numbers[i]), NULL, 10) > 0)
            return numbers[i];
    return NULL;
}

/* Without MPI each process would make the whole file. */
bool ranks_begin(struct ranks *ranks) {
    *ranks = (struct ranks){0, 1, NULL};
    const char *mark = launched_as_one_of_several();
    if (mark)
        complain("%s is %s, so this is one of several ranks of MPI, but this build has no MPI: build with "
                 "-Dmpi=enabled, or start one process with --threads",
                 mark, getenv(mark));
    return !mark;
}

void ranks_end(struct ranks *ranks) {
    (void)ranks;
}

bool ranks_agree(const struct ranks *ranks, bool good) {
    (void)ranks;
    return good;
}

bool ranks_exchange(void *context, const void *own, size_t size, void **ret_all, size_t *ret_size) {
    (void)context;
    *ret_all = (void *)own;
    *ret_size = size;
    return true;
}

void ranks_stop(const struct ranks *ranks) {
    (void)ranks;
}

uint64_t ranks_next(const struct ranks *ranks) {
    (void)ranks;
    return UINT64_MAX;
}

uint64_t ranks_done(const struct ranks *ranks) {
    (void)ranks;
    return 0;
}

pir_status ranks_run(struct ranks *ranks, pir_cspace_job *job, uint64_t pairs, pir_report *report) {
    (void)ranks;
    (void)pairs;
    return pir_cspace_job_run(job, report);
}

#endif
