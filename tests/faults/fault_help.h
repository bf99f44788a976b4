/* fault_help.h - runs of a function in a child process with an injected fault, and counts of the outcomes. Include
   after test.h. */
#pragma once
#include "fault.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#define FAULT_TENTH 10

/* A tenth of the cases in every run, all with WR_FULL=1; `salt` varies the selection between tests. */
static inline bool fault_is_wanted(int64_t index, int64_t salt)
{
    const char *full = getenv("WR_FULL");
    return (full && full[0] == '1') || (index + salt) % FAULT_TENTH == 0;
}

/* True for modes that apply to a kind of call. */
static inline bool fault_fits(FaultKind kind, FaultMode mode)
{
    if (mode == FAULT_ERROR || mode == FAULT_KILL) return true;
    if (mode == FAULT_PLANT) return kind == FAULT_OPEN;
    if (mode == FAULT_STUCK) return kind == FAULT_RENAME || kind == FAULT_LINK;
    if (mode == FAULT_FLIP || mode == FAULT_DROP) return kind == FAULT_WRITE;
    return kind == FAULT_WRITE && (mode == FAULT_SHORT || mode == FAULT_TORN);
}

/* Counts of the outcomes. */
typedef struct FaultTally {
    long cases, errors, successes, killed_old, killed_new;
    long kills[FAULT_PLACES][FAULT_STAGES];
} FaultTally;

static inline void fault_tell(const char *name, const FaultTally *t)
{
    printf("%-10s %5ld cases: %ld errors over a whole old file, %ld successes, %ld kills (%ld old, "
           "%ld new)\n",
           name, t->cases, t->errors, t->successes, t->killed_old + t->killed_new, t->killed_old,
           t->killed_new);
    for (int place = 0; place < FAULT_PLACES; place++)
        for (int stage = 0; stage < FAULT_STAGES; stage++)
            if (t->kills[place][stage])
                printf("             kills at %s, %s: %ld\n", wr_fault_places[place],
                       wr_fault_stages[stage], t->kills[place][stage]);
    fflush(stdout);
}

static inline void fault_add(FaultTally *to, const FaultTally *t)
{
    to->cases += t->cases;
    to->errors += t->errors;
    to->successes += t->successes;
    to->killed_old += t->killed_old;
    to->killed_new += t->killed_new;
    for (int i = 0; i < FAULT_PLACES * FAULT_STAGES; i++)
        (&to->kills[0][0])[i] += (&t->kills[0][0])[i];
}

/* fork, but the child ends with its parent, and after two minutes at the latest. */
static inline pid_t fault_fork(void)
{
    pid_t child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL);
        alarm(120);
    }
    return child;
}

static inline int fault_wait(pid_t child)
{
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    return status;
}

/* The caller frees the bytes with wr_free. */
static inline void fault_read_whole(const char *path, char **bytes, size_t *length)
{
    WrError err;
    if (!wr_file_read(path, 1 << 28, bytes, length, &err)) fail_msg("%s", err.text);
}

static inline bool fault_holds(const char *path, const char *bytes, size_t length)
{
    char *have;
    size_t own;
    fault_read_whole(path, &have, &own);
    const bool same = own == length && memcmp(have, bytes, length) == 0;
    wr_free(have);
    return same;
}

/* Count in the current folder. */
static inline int fault_hidden_files(void)
{
    DIR *dir = opendir(".");
    int hidden = -2; /* excludes . and .. */
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));) hidden += entry->d_name[0] == '.';
    closedir(dir);
    return hidden;
}
