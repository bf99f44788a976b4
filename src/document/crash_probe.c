/* Runs a function in a child process, so that a crash ends only the child. */
#include "document/recover.h"

#include "base/error.h"
#include "base/progress.h"
#include "system/child.h"

#include <errno.h>
#include <string.h>

#define LEAST_SECONDS 0.02

/* The child's result, sent before it ends; small enough for one write. */
typedef struct Verdict {
    bool result;
    WrError err;
} Verdict;

typedef struct Trial {
    WrProbeFunction function;
    void *ctx;
} Trial;

static void work(void *ctx, void *answer)
{
    const Trial *trial = ctx;
    Verdict *verdict = answer;
    verdict->result = trial->function(trial->ctx, &verdict->err);
}

static WrProbeEnd judge(const Verdict *verdict, WrError *err)
{
    if (verdict->result) return WR_PROBE_TRUE;
    wr_fail(err, "%s", wr_error_message(&verdict->err));
    return WR_PROBE_FALSE;
}

static WrProbeEnd tell_crash(WrChildEnd end, WrError *err)
{
    const char *name = wr_child_crash(end.number);
    if (end.why == WR_CHILD_LEFT)
        wr_fail(err, "it ended the program by itself (status %d)", end.number);
    else wr_fail(err, "it crashed: %s (signal %d)", name ? name : "unknown", end.number);
    return WR_PROBE_CRASHED;
}

WrProbeEnd wr_journal_trial(WrProbeFunction function, void *ctx, double seconds, size_t bytes,
                            WrError *err)
{
    Verdict verdict;
    WrChildEnd end;
    Trial trial = { function, ctx };
    if (!(seconds > 0)) seconds = LEAST_SECONDS;
    if (seconds > 1e6) seconds = 1e6;
    WrTry it = { .work = work,
                 .ctx = &trial,
                 .answer = &verdict,
                 .length = sizeof verdict,
                 .seconds = seconds,
                 .memory = bytes,
                 .stopped = wr_progress_stopped };
    const WrTryResult result = wr_child_try(&it, &end);
    verdict.err.text[sizeof verdict.err.text - 1] = '\0';
    if (result == WR_TRY_ANSWERED) return judge(&verdict, err);
    if (result == WR_TRY_ENDED) return tell_crash(end, err);
    if (result == WR_TRY_LATE) {
        wr_fail(err, "it took more than %g s", seconds);
        return WR_PROBE_TIMEOUT;
    }
    wr_fail(err, "no %s a trial: %s", result == WR_TRY_NO_PIPE ? "pipe to" : "child for",
            strerror(errno));
    return WR_PROBE_UNABLE;
}
