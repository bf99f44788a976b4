/* child.h - other processes: programs that are started, copies of this one, and how they ended.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include "system/process.h"

/* ---- how one ended ---- */

typedef enum WrChildWhy {
    WR_CHILD_LEFT,   /* by itself: number is its status */
    WR_CHILD_LATE,   /* at its limit of processor time */
    WR_CHILD_KILLED, /* by somebody, or for want of memory */
    WR_CHILD_CRASHED /* number tells how: wr_child_crash */
} WrChildWhy;

typedef struct WrChildEnd {
    WrChildWhy why;
    int number;
} WrChildEnd;

const char *
wr_child_crash(int number); /* "Segmentation fault"; NULL where the system has no word */

/* ---- programs ---- */

typedef struct WrChildStart {
    const char *program;          /* a path, or with `search` a name */
    const char *const *arguments; /* the first is its own name; ends in NULL */
    int in, out, err;             /* open files; -1: ours */
    bool search;                  /* where the user's programs are looked for */
    bool apart; /* gets no other open file, no signal kept from it, and a session of its own */
    bool
        bound; /* apart, and killed when the thread that starts it is gone, where the system has such */
} WrChildStart;

int wr_child_start(const WrChildStart *start, WrPid *child); /* 0, or what errno would say */

/* Wait until it ends; false if it is no child of ours. */
bool wr_child_wait(WrPid child, WrChildEnd *end);
bool wr_child_ended(WrPid child,
                    WrChildEnd *end); /* the same without waiting: false while it runs */
bool wr_child_is_gone(WrPid child); /* it ended, which is then forgotten, or is no child of ours */
void wr_child_kill(WrPid child);
void wr_child_ask_to_end(WrPid child);

/* ---- copies ---- */

/* 0 in the copy, its number here; -1: there is none to be had, or the system knows no such thing. The copy has only the
   thread that called. */
WrPid wr_child_fork(void);

/* To be told of children that end: call the first before any thread is started, the second after; it gives a file that
   can be read when one has ended, or -1. */
void wr_children_hold(void);
int wr_children_watch(void);
/* The next child that ended; 0: no other has. */
WrPid wr_children_next(int watch, WrChildEnd *end);
void wr_children_wait_for_all(void);

/* ---- trying something in a copy ---- */

typedef struct WrTry {
    void (*work)(void *ctx, void *answer); /* in the copy, its standard files leading nowhere */
    void *ctx;
    void *answer;  /* what the work made of it, here; zeroed before */
    size_t length; /* of it; a few hundred bytes */
    double seconds;
    uint64_t memory;       /* bytes more than now; 0: any */
    bool (*stopped)(void); /* asked now and then: whether nobody waits any more */
} WrTry;

typedef enum WrTryResult {
    WR_TRY_ANSWERED,
    WR_TRY_ENDED, /* without an answer: *end says how */
    WR_TRY_LATE,  /* and was killed */
    WR_TRY_NO_PIPE,
    WR_TRY_NO_CHILD /* errno says why */
} WrTryResult;
WrTryResult wr_child_try(const WrTry *it, WrChildEnd *end);
