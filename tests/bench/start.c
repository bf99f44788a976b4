/* Start of the program, and opening and saving of documents: most rows run the program itself. Processor time includes the
   reader process. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "bench/bench.h"
#include "cli/cli.h"
#include "command/session.h"
#include "system/clock.h"
#include "system/path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define ROUNDS 21

/* Processor seconds of all processes that were started here and have ended. */
static double children_seconds(void)
{
    struct rusage used;
    getrusage(RUSAGE_CHILDREN, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/* Runs the program with these words in a folder, which has its settings too. False if it failed. */
static bool run(const char *folder, const char *words)
{
    char *beside = wr_program_folder();
    WrText line = { 0 };
    wr_text_addf(&line,
                 "cd '%s' && HOME='%s' XDG_CONFIG_HOME='%s' WRINKLE_STATE='%s' "
                 "SDL_VIDEODRIVER=dummy WRINKLE_RENDERER=software WRINKLE_TIMING=%.6f "
                 "'%s/wrinkle' %s >out 2>report </dev/null",
                 folder, folder, folder, folder, wr_clock_seconds(), beside, words);
    const bool good = !strchr(beside, '\'') && system(wr_text_get(&line)) == 0;
    wr_text_fini(&line);
    wr_free(beside);
    return good;
}

/* Milliseconds from the command to the first picture; negative: no report. */
static double first_picture(const char *folder)
{
    char path[64], *report = NULL;
    double ms = -1;
    size_t length;
    WrError err;
    snprintf(path, sizeof path, "%s/report", folder);
    if (!run(folder, "paint") || !wr_file_read(path, 65536, &report, &length, &err) ||
        sscanf(report, "first picture after %lf", &ms) != 1)
        ms = -1;
    wr_free(report);
    return ms;
}

/* One line: median and 95th percentile. */
static void add_row(WrText *text, const char *label, double *values, int count, const char *unit)
{
    const double median = wr_bench_median(values, count); /* sorts */
    wr_text_addf(text, "  %-58s %8.3g %8.3g %s\n", label, median,
                 values[(int)(0.95 * (count - 1) + 0.5)], unit);
}

static bool time_starts(const char *folder, int count, WrText *text)
{
    double version[ROUNDS], seconds[ROUNDS], window[ROUNDS];
    bool good = run(folder, "--version") && first_picture(folder) > 0; /* reads files from disk */
    for (int i = 0; i < count && good; i++) {
        const double used = children_seconds(), start = wr_clock_seconds();
        good = run(folder, "--version");
        version[i] = 1e3 * (wr_clock_seconds() - start);
        seconds[i] = 1e3 * (children_seconds() - used);
        good = good && (window[i] = first_picture(folder)) > 0;
    }
    if (!good) return false;
    add_row(text, "wrinkle --version, with a shell", version, count, "ms");
    add_row(text, "the same, processor time", seconds, count, "ms");
    add_row(text, "the window's first picture, without a display", window, count, "ms");
    return true;
}

/* Four layers: noise, and strokes of three sizes. */
static bool make_document(const char *folder, int size)
{
    char path[64];
    WrText script = { 0 };
    WrError err;
    wr_text_addf(&script,
                 "table %dx%d\nnoise perlin cells=6 octaves=5\n"
                 "layer add\nstroke points=0.1,0.1;0.8,0.6;0.3,0.9 radius=60\n"
                 "layer add\nstroke points=0.2,0.7;0.7,0.2 radius=200 strength=0.3\n"
                 "layer add\nstroke points=0.5,0.1;0.5,0.8 radius=30\nsave four.exr\n",
                 size, size);
    snprintf(path, sizeof path, "%s/make.wrinkle", folder);
    bool good = wr_file_write(path, script.data, script.length, &err);
    snprintf(path, sizeof path, "%s/open.wrinkle", folder);
    good = good && wr_file_write(path, "open four.exr\n", 14, &err);
    snprintf(path, sizeof path, "%s/save.wrinkle", folder);
    good = good && wr_file_write(path, "open four.exr\nsave again.exr\n", 29, &err);
    wr_text_fini(&script);
    return good && run(folder, "run make.wrinkle");
}

/* Saving is the difference to opening alone. */
static bool time_document(const char *folder, int size, int count, WrText *text)
{
    double opened[ROUNDS], saved[ROUNDS], open_seconds[ROUNDS], save_seconds[ROUNDS];
    bool good = make_document(folder, size);
    for (int i = 0; i < count && good; i++) {
        const double used = children_seconds(), start = wr_clock_seconds();
        good = run(folder, "run open.wrinkle");
        opened[i] = wr_clock_seconds() - start;
        open_seconds[i] = children_seconds() - used;
        good = good && run(folder, "run save.wrinkle");
        saved[i] = wr_clock_seconds() - start - 2 * opened[i];
        save_seconds[i] = children_seconds() - used - 2 * open_seconds[i];
    }
    if (!good) return false;
    wr_text_addf(text, "  document %dx%d, four layers\n", size, size);
    add_row(text, "  open", opened, count, "s");
    add_row(text, "  open, processor time", open_seconds, count, "s");
    add_row(text, "  save, read back and compared", saved, count, "s");
    add_row(text, "  save, processor time", save_seconds, count, "s");
    return true;
}

/* As in the window, where the program runs already. The first edit begins the journal, which keeps a copy of the file. */
static bool time_session(const WrCli *cli, const char *folder, int count, WrText *text)
{
    double opened[ROUNDS], edited[ROUNDS];
    char path[64];
    WrError err;
    const WrSessionOptions options = { .pool = cli->pool, .journal = true };
    snprintf(path, sizeof path, "%s/four.exr", folder);
    setenv("WRINKLE_STATE", folder, 1);
    bool good = true;
    for (int i = 0; i < count && good; i++) {
        WrSession *session = wr_session_new(&options);
        const double start = wr_clock_seconds();
        good = wr_session_open(session, path, &err);
        opened[i] = wr_clock_seconds() - start;
        good = good && wr_session_run(session, "dab at=0.31,0.67 radius=20", &err);
        edited[i] = 1e3 * (wr_clock_seconds() - start - opened[i]);
        wr_session_free(session);
    }
    if (!good) return false;
    add_row(text, "  open in a program that runs", opened, count, "s");
    add_row(text, "  the first dab after it, with the journal", edited, count, "ms");
    return true;
}

bool wr_bench_start(const WrCli *cli, bool quick, WrText *text, WrError *err)
{
    char folder[] = "/tmp/wrinkle-bench-XXXXXX", remove[64];
    if (!wr_folder_make_temporary(folder))
        return wr_fail(err, "%s: no folder can be made there", folder);
    wr_text_addf(text, "\n%-60s %8s %8s\n", "start, open, save", "median", "95 %");
    const bool good = time_starts(folder, quick ? 3 : ROUNDS, text) &&
                      time_document(folder, quick ? 512 : 4096, quick ? 3 : 11, text) &&
                      time_session(cli, folder, quick ? 3 : 11, text);
    snprintf(remove, sizeof remove, "rm -r '%s'", folder);
    if (system(remove) != 0) wr_text_addf(text, "%s: cannot be removed\n", folder);
    if (wr_cancel_requested(cli->cancel)) return wr_fail(err, "interrupted");
    return good || wr_fail(err, "bench: start: the program beside this one could not be run");
}
