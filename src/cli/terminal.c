/* Progress and remaining time of long work, on the terminal's last line. */
#include "base/progress.h"
#include "cli/cli.h"
#include "system/clock.h"
#include "system/process.h"
#include "system/thread.h"

#include <math.h>
#include <stdio.h>

#define SILENT_SECONDS 1.0 /* shorter work is not reported */
#define STEP_SECONDS 0.2

static WrMutex lock = WR_MUTEX_READY; /* guards the line: notes come from several threads */
static struct {
    double began, printed_at; /* clock readings */
    bool shown;
    WrTimeLeft left;
    WrProgress *progress; /* progress that is reported */
} line;

static void report(void *ctx, double fraction)
{
    (void)ctx;
    double now = wr_clock_seconds();
    const double left = wr_time_left(&line.left, fraction, now - line.began);
    if (now - line.began < SILENT_SECONDS || now - line.printed_at < STEP_SECONDS) return;
    char time[24] = "";
    if (left < 60000.0)
        snprintf(time, sizeof time, "%d:%02d left", (int)rint(left) / 60, (int)rint(left) % 60);
    wr_mutex_lock(&lock);
    fprintf(stderr, "\r%3.0f %%  %-16s", 100.0 * fraction, time);
    line.printed_at = now;
    line.shown = true;
    wr_mutex_unlock(&lock);
}

void wr_cli_progress_begin(WrProgress *progress)
{
    if (!wr_process_has_terminal()) return;
    line.began = wr_clock_seconds();
    progress->report = report;
    line.progress = progress;
}

void wr_cli_progress_resume(void)
{
    wr_cli_progress_clear();
    line.began = line.printed_at = wr_clock_seconds();
}

void wr_cli_progress_clear(void)
{
    wr_mutex_lock(&lock);
    if (line.shown) fprintf(stderr, "\r%*s\r", 24, "");
    line.shown = false;
    wr_mutex_unlock(&lock);
}

void wr_cli_progress_stop(void)
{
    wr_cli_progress_clear();
    if (line.progress) line.progress->report = NULL;
}
