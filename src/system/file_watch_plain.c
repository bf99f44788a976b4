/* File watching by polling twice a second: changes are reported late, and a change that keeps size and
   times is missed. */
#include "system/file_watch.h"

#include "system/path.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define CHECK_SECONDS 0.5

struct WrWatch {
    WrFileInfo last;
    bool there;
    WrWatch *more; /* the next path; NULL: none */
    char path[];
};

WrWatch *wr_watch_new(const char *path)
{
    WrWatch *watch = calloc(1, sizeof *watch + strlen(path) + 1);
    if (!watch) return NULL;
    strcpy(watch->path, path);
    watch->there = wr_path_info(path, &watch->last);
    return watch;
}

void wr_watch_free(WrWatch *watch)
{
    for (WrWatch *more; watch; watch = more) {
        more = watch->more;
        free(watch);
    }
}

bool wr_watch_add(WrWatch *watch, const char *path)
{
    WrWatch *one = wr_watch_new(path);
    if (!one) return false;
    one->more = watch->more;
    watch->more = one;
    return true;
}

static bool has_changed(WrWatch *watch)
{
    WrFileInfo now;
    if (!wr_path_info(watch->path, &now)) return false; /* being replaced, or removed */
    const WrFileInfo *last = &watch->last;
    const bool same = watch->there && now.device == last->device && now.inode == last->inode &&
                      now.bytes == last->bytes && now.seconds == last->seconds &&
                      now.nanoseconds == last->nanoseconds;
    watch->last = now;
    watch->there = true;
    return !same;
}

WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds)
{
    for (;;) {
        for (WrWatch *one = watch; one; one = one->more)
            if (has_changed(one)) return WR_WATCH_CHANGED;
        if (!(seconds > 0)) return WR_WATCH_NOTHING;
        const double rest = seconds < CHECK_SECONDS ? seconds : CHECK_SECONDS;
        const struct timespec nap = { (time_t)rest, (long)((rest - (double)(time_t)rest) * 1e9) };
        if (nanosleep(&nap, NULL) != 0) return WR_WATCH_NOTHING; /* interrupted */
        seconds -= rest;
    }
}
