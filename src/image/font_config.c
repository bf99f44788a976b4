#include "image/font_config.h"

#include "base/once_async.h"
#include "base/error.h"
#include "base/progress.h"
#include "system/child.h"

#include <fontconfig/fontconfig.h>

#define SECONDS 120.0
#define BYTES ((uint64_t)2 << 30)

static void try_load(void *ctx, void *answer)
{
    (void)ctx;
    *(bool *)answer = FcInit();
}

static bool crashed(WrChildEnd end, WrError *err)
{
    const char *name = wr_child_crash(end.number);
    return wr_fail(err, "fontconfig falls over one of the installed fonts (%s)",
                   end.why == WR_CHILD_LATE ? "it does not end"
                   : name                   ? name
                                            : "it ended");
}

/* The copy has cached its results in files, so only those are read here. */
static bool load(void *ctx, WrError *err)
{
    bool good = false;
    WrChildEnd end;
    const WrTry it = { .work = try_load,
                       .answer = &good,
                       .length = sizeof good,
                       .seconds = SECONDS,
                       .memory = BYTES,
                       .stopped = wr_progress_stopped };
    const WrTryResult result = wr_child_try(&it, &end);
    (void)ctx;
    if (result == WR_TRY_ENDED) return crashed(end, err);
    if (result == WR_TRY_LATE) return wr_fail(err, "fontconfig: no list of fonts in %g s", SECONDS);
    if (result == WR_TRY_ANSWERED && !good) return wr_fail(err, "fontconfig does not work");
    return FcInit() ||
           wr_fail(err, "fontconfig does not work"); /* also if no copy can be started */
}

bool wr_font_config(WrError *err)
{
    static WrOnceAsync list = { .work = load };
    return wr_once_async_wait(&list, err);
}
