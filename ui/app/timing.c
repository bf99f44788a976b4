/* Frame times of the window on request. */
#include "ui/app/timing.h"
#include "ui/state/app_state.h"
#include "ui/preview/preview.h"

#include "base/text.h"
#include "image/image.h"
#include "system/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* WRINKLE_TIMING: print milliseconds to the first frame at once, the rest at the end. A value above 1 is the clock at
   the start command: times are counted from it, and the window closes. */
static void tell_first(WrApp *app)
{
    const char *asked = getenv("WRINKLE_TIMING");
    double from;
    if (!asked) return;
    const bool timed = wr_number_parse(asked, strlen(asked), &from) && from > 1;
    fprintf(stderr, "first picture after %.1f ms\n",
            (wr_clock_seconds() - (timed ? from : app->started_at)) * 1e3);
    if (timed) app->quit = true;
}

void wr_timing_note(WrApp *app, double seconds)
{
    WrTiming *t = app->timing;
    if (t->pictures++ == 0) tell_first(app);
    /* Start the reader process after the first frames, so that the first picture file loads fast and the start is not
       delayed. */
    if (t->pictures == 2 && !app->latency) wr_image_warm();
    t->seconds += seconds;
    t->slowest = seconds > t->slowest ? seconds : t->slowest;
}

void wr_timing_report(const WrApp *app)
{
    const WrTiming *t = app->timing;
    const WrPreviewPicture *p = wr_preview_picture(app->preview);
    if (!getenv("WRINKLE_TIMING") || t->pictures == 0) return;
    fprintf(
        stderr,
        "%d pictures of the window, %.2f ms each, slowest %.2f ms; %llu of the patch in %.1f s\n",
        t->pictures, t->seconds / t->pictures * 1e3, t->slowest * 1e3,
        (unsigned long long)p->serial, wr_clock_seconds() - app->started_at);
}
