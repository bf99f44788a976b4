/* child.h - child processes: started programs, forks of this process, and their exit status.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include "system/process.h"

/* ---- exit status ---- */

typedef enum WrChildWhy {
    WR_CHILD_LEFT,   /* exited by itself; number is its status */
    WR_CHILD_LATE,   /* reached its limit of processor time */
    WR_CHILD_KILLED, /* killed by a user, or by the system when out of memory */
    WR_CHILD_CRASHED /* number is the kind of crash: wr_child_crash */
} WrChildWhy;

typedef struct WrChildEnd {
    WrChildWhy why;
    int number;
} WrChildEnd;

const char *
wr_child_crash(int number); /* for example "Segmentation fault"; NULL if the system has no name */

/* ---- programs ---- */

typedef struct WrChildStart {
    const char *program;          /* a path, or with `search` a name */
    const char *const *arguments; /* the first is the program's own name; ends in NULL */
    int in, out, err;             /* open files; -1: inherited from this process */
    bool search;                  /* search the user's PATH */
    bool apart;                   /* no other open file, no blocked signals, a session of its own */
    bool bound; /* like apart; also killed when the thread that started it ends, where the system
                  supports it */
} WrChildStart;

int wr_child_start(const WrChildStart *start, WrPid *child); /* 0, or an errno value */

/* Waits until it ends; false if it is not a child of this process. */
bool wr_child_wait(WrPid child, WrChildEnd *end);
bool wr_child_ended(WrPid child,
                    WrChildEnd *end); /* wr_child_wait without waiting: false while it runs */
/* it ended (and is reaped), or is not a child of this process */
bool wr_child_is_gone(WrPid child);
void wr_child_kill(WrPid child);

/* ---- forks ---- */

/* Returns 0 in the copy, its number in this process; -1 on failure or where forks are unsupported. The
   copy has only the calling thread. */
WrPid wr_child_fork(void);

/* Notification of ended children: call the first before any thread is started, the second after it;
   that returns a file that becomes readable when a child has ended, or -1. */
void wr_children_hold(void);
int wr_children_watch(void);
/* The next child that ended; 0: none. */
WrPid wr_children_next(int watch, WrChildEnd *end);
void wr_children_wait_for_all(void);

/* ---- running work in a forked copy ---- */

typedef struct WrTry {
    /* runs in the copy, whose standard files are redirected to nowhere */
    void (*work)(void *ctx, void *answer);
    void *ctx;
    void *answer;  /* result of the work, in this process; zeroed before */
    size_t length; /* of the result; a few hundred bytes */
    double seconds;
    uint64_t memory;       /* limit in bytes above the present use; 0: no limit */
    bool (*stopped)(void); /* polled: true if the caller no longer waits */
} WrTry;

typedef enum WrTryResult {
    WR_TRY_ANSWERED,
    WR_TRY_ENDED, /* without a result: *end has the exit status */
    WR_TRY_LATE,  /* timed out and was killed */
    WR_TRY_NO_PIPE,
    WR_TRY_NO_CHILD /* errno has the reason */
} WrTryResult;
WrTryResult wr_child_try(const WrTry *it, WrChildEnd *end);
