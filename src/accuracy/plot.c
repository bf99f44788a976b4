/* Error against time as a picture, drawn by gnuplot. */
#include "accuracy/report.h"

#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#define DRAWING_MAX ((size_t)256 << 20) /* bytes */

extern char **environ;

/* ---- the script ---- */

/* A string in gnuplot's single quotes: only the quote itself needs care. */
static void add_quoted(WrText *text, const char *bytes)
{
    wr_text_add(text, "'");
    for (; *bytes; bytes++) {
        if (*bytes == '\'') wr_text_add(text, "'");
        if ((unsigned char)*bytes >= ' ') wr_text_add_n(text, bytes, 1);
    }
    wr_text_add(text, "'");
}

/* A rung that has a place in a plot with logarithmic axes. */
static bool placed(const WrRung *rung)
{
    return !rung->note.text[0] && !rung->model && rung->errors.rms > 0 && rung->seconds > 0;
}

static void add_points(const WrLadder *ladder, int axis, WrText *text)
{
    for (int i = 0; i < ladder->count; i++) {
        const WrRung *rung = &ladder->rungs[i];
        if (placed(rung) && (int)rung->axis == axis && !rung->current)
            wr_text_addf(text, "%.6g %.6g %.6g\n", 1e3 * rung->seconds, rung->errors.rms,
                         1e3 * rung->spread);
    }
}

static int by_time(const void *a, const void *b)
{
    const WrRung *const *x = a, *const *y = b;
    return ((*x)->seconds > (*y)->seconds) - ((*x)->seconds < (*y)->seconds);
}

/* The front from fast to near. The caller frees. */
static const WrRung **front_of(const WrLadder *ladder, int *count)
{
    const WrRung **front = wr_alloc((size_t)ladder->count + 1, sizeof *front);
    *count = 0;
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].front && placed(&ladder->rungs[i]))
            front[(*count)++] = &ladder->rungs[i];
    qsort(front, (size_t)*count, sizeof *front, by_time);
    return front;
}

static void add_data(const WrLadder *ladder, const WrRung **front, int fronts, WrText *text)
{
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        wr_text_addf(text, "$axis%d << EOD\n", axis);
        add_points(ladder, axis, text);
        wr_text_add(text, "EOD\n");
    }
    wr_text_add(text, "$front << EOD\n");
    for (int i = 0; i < fronts; i++)
        wr_text_addf(text, "%.6g %.6g %d\n", 1e3 * front[i]->seconds, front[i]->errors.rms, i + 1);
    wr_text_add(text, "EOD\n$now << EOD\n");
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].current && placed(&ladder->rungs[i]))
            wr_text_addf(text, "%.6g %.6g\n", 1e3 * ladder->rungs[i].seconds,
                         ladder->rungs[i].errors.rms);
    wr_text_add(text, "EOD\n");
}

/* ---- the frame ---- */

typedef struct Range {
    double low, high;
} Range;

static void widen(Range *range, double value)
{
    if (!(value > 0)) return;
    range->low = range->low > 0 ? fmin(range->low, value) : value;
    range->high = fmax(range->high, value);
}

/* All that is shown, and a little air. The reference's own line belongs to it where it is not far below. */
static void ranges_of(const WrLadder *ladder, Range *time, Range *error)
{
    *time = *error = (Range){ 0, 0 };
    for (int i = 0; i < ladder->count; i++) {
        if (!placed(&ladder->rungs[i])) continue;
        widen(time, 1e3 * ladder->rungs[i].seconds);
        widen(error, ladder->rungs[i].errors.rms);
    }
    if (!(time->low > 0)) *time = *error = (Range){ 1, 1 }; /* nothing is shown */
    if (ladder->reference.last_rms > error->low / 10) widen(error, ladder->reference.last_rms);
    *time = (Range){ time->low / 1.4, time->high * 1.4 };
    *error = (Range){ error->low / 1.6, error->high * 1.6 };
}

/* How far along the axis, 0..1. */
static double along(Range range, double value)
{
    return log(value / range.low) / log(range.high / range.low);
}

/* A place on the plot, each 0..1 along its axis. */
typedef struct Spot {
    double x, y;
} Spot;

/* What a number takes, and how far it stands from its point. */
#define NUMBER_W 0.028
#define NUMBER_H 0.032
#define NUMBER_OFF 0.02

static bool taken(const Spot *spots, int count, Spot at)
{
    for (int i = 0; i < count; i++)
        if (fabs(spots[i].x - at.x) < NUMBER_W && fabs(spots[i].y - at.y) < NUMBER_H) return true;
    return false;
}

/* The nearest free place round a point: in rings about it, the first above and to the right. */
static Spot place_number(const Spot *spots, int count, Spot point)
{
    for (int ring = 1; ring < 12; ring++)
        for (int turn = 0; turn < 8; turn++) {
            const double angle = WR_PI * (0.25 + (turn % 2 ? -1 : 1) * 0.25 * ((turn + 1) / 2));
            const Spot at = { point.x + ring * NUMBER_OFF * cos(angle),
                              point.y + ring * 1.4 * NUMBER_OFF * sin(angle) };
            if (at.x > 0.01 && at.x < 0.99 && at.y > 0.02 && at.y < 0.98 &&
                !taken(spots, count, at))
                return at;
        }
    return (Spot){ point.x, point.y + NUMBER_OFF };
}

/* The numbers on the front, beside their points, none over another or over a point, each tied to its own by a
   line. */
static void add_numbers(const WrLadder *ladder, const WrRung **front, int fronts, WrText *text)
{
    Range time, error;
    Spot *spots = wr_alloc(2 * (size_t)fronts + 1, sizeof *spots);
    ranges_of(ladder, &time, &error);
    for (int i = 0; i < fronts; i++)
        spots[i] =
            (Spot){ along(time, 1e3 * front[i]->seconds), along(error, front[i]->errors.rms) };
    for (int i = 0; i < fronts; i++) {
        const Spot at = spots[fronts + i] = place_number(spots, fronts + i, spots[i]);
        wr_text_addf(
            text,
            "set arrow %d from graph %.4f, graph %.4f to graph %.4f, graph %.4f nohead lw 0.7 "
            "lc rgb '#808080' back\nset label %d '%d' at graph %.4f, graph %.4f center font "
            "',9' front\n",
            500 + i, at.x, at.y, spots[i].x, spots[i].y, 500 + i, i + 1, at.x, at.y);
    }
    wr_free(spots);
}

/* The front's numbers and settings, down the right margin. */
static void add_names(const WrRung **front, int fronts, WrText *text)
{
    WrText setting = { 0 };
    wr_text_add(text, "set label 1000 'the front, fast to near: what differs from that' noenhanced "
                      "at screen 0.70, screen 0.60 font ',11'\n");
    for (int i = 0; i < fronts && i < 24; i++) {
        wr_text_clear(&setting);
        wr_text_addf(&setting, "%s%d  ", i < 9 ? "\xe2\x80\x87" : "", i + 1); /* figure space */
        wr_setting_print(&front[i]->setting, &setting);
        wr_text_addf(text, "set label %d ", 1001 + i);
        add_quoted(text, wr_text_get(&setting));
        wr_text_addf(text, " noenhanced at screen 0.70, screen %.4f font ',9'\n",
                     0.565 - 0.0225 * i);
    }
    wr_text_fini(&setting);
}

/* The setting that the names differ from. */
static void add_present(const WrLadder *ladder, WrText *text)
{
    WrText words = { 0 };
    for (int i = 0; i < ladder->count; i++)
        if (ladder->rungs[i].current)
            wr_text_addf(&words, "as it stands: %s", ladder->rungs[i].full);
    wr_text_add(text, "set label 999 ");
    add_quoted(text, wr_text_get(&words));
    wr_text_add(text, " noenhanced at screen 0.38, screen 0.943 center font ',9'\n");
    wr_text_fini(&words);
}

/* 1, 2 and 5 of each power of ten, written out. */
static void add_ticks(const char *axis, Range range, WrText *text)
{
    static const double numbers[] = { 1, 2, 5 };
    const char *comma = "";
    wr_text_addf(text, "set %stics (", axis);
    for (int power = (int)floor(log10(range.low)); power <= (int)ceil(log10(range.high)); power++)
        for (int i = 0; i < 3; i++) {
            const double at = numbers[i] * pow(10, power);
            if (at < range.low || at > range.high) continue;
            wr_text_addf(text, "%s'%.6g' %.6g", comma, at, at);
            comma = ", ";
        }
    wr_text_add(text, ")\n");
}

/* One colour and one mark an axis, from a palette that the colour-blind can tell apart. */
static void add_series(WrText *text)
{
    static const struct {
        const char *colour;
        int mark;
    } looks[WR_AXIS_COUNT + 1] = { { "#0072b2", 7 },  { "#d55e00", 5 },  { "#009e73", 9 },
                                   { "#cc79a7", 11 }, { "#e69f00", 13 }, { "#56b4e9", 15 } };
    wr_text_add(text, "plot $front using 1:2 with steps lw 2 lc rgb '#303030' title 'front', \\\n");
    for (int axis = 0; axis <= WR_AXIS_COUNT; axis++) {
        wr_text_addf(text,
                     "  $axis%d using 1:2:3 with xerrorbars pt %d ps 1.2 lw 1.4 lc rgb '%s' title "
                     "'%s', \\\n",
                     axis, looks[axis].mark, looks[axis].colour,
                     axis < WR_AXIS_COUNT ? wr_axis_labels[axis] : "combinations");
    }
    wr_text_add(text, "  $now using 1:2 with points pt 6 ps 2.6 lw 2.5 lc rgb '#000000' title 'as "
                      "it stands'\n");
}

void wr_report_plot_script(const WrLadder *ladder, const char *name, const char *terminal,
                           WrText *text)
{
    int fronts;
    const WrRung **front = front_of(ladder, &fronts);
    WrText title = { 0 };
    wr_text_addf(&title, "%s%sError against time, %d x %d pixels, %d %s", name, name[0] ? ": " : "",
                 ladder->width, ladder->height, ladder->threads,
                 ladder->threads == 1 ? "thread" : "threads");
    add_data(ladder, front, fronts, text);
    wr_text_addf(text,
                 "set terminal %s size 1280,800 font 'DejaVu Sans,11' background rgb "
                 "'#ffffff'\nset title ",
                 terminal);
    add_quoted(text, wr_text_get(&title));
    wr_text_add(
        text, " noenhanced font ',14'\n"
              "set logscale xy\n"
              "set xlabel 'time of a frame, ms'\n"
              "set ylabel 'RMS error of linear intensity'\n"
              "set grid xtics ytics mxtics mytics lc rgb '#b4b4b4' lw 1, lc rgb '#dedede' lw 0.7\n"
              "set lmargin at screen 0.085\nset rmargin at screen 0.68\n"
              "set key at screen 0.695, screen 0.90 left top Left reverse samplen 1.5 "
              "spacing 1.15\n"
              "");
    Range time, error;
    ranges_of(ladder, &time, &error);
    wr_text_addf(text, "set xrange [%.6g:%.6g]\nset yrange [%.6g:%.6g]\n", time.low, time.high,
                 error.low, error.high);
    add_ticks("x", time, text);
    add_ticks("y", error, text);
    add_numbers(ladder, front, fronts, text);
    if (ladder->reference.last_rms > error.low)
        wr_text_addf(text,
                     "set arrow 1 from graph 0, first %.6g to graph 1, first %.6g nohead dt 2 "
                     "lc rgb '#909090'\nset label 1 'the reference, at its last doubling' at "
                     "graph 0.01, first %.6g offset 0,0.6 font ',9' tc rgb '#606060'\n",
                     ladder->reference.last_rms, ladder->reference.last_rms,
                     ladder->reference.last_rms);
    add_names(front, fronts, text);
    add_present(ladder, text);
    add_series(text);
    wr_text_fini(&title);
    wr_free(front);
}

/* ---- the program ---- */

/* gnuplot, reading, drawing and complaining to open files. */
static bool spawn(int in, int out, int complaints, pid_t *pid, WrError *err)
{
    posix_spawn_file_actions_t actions;
    char *const arguments[] = { "gnuplot", "-d", "-", NULL }; /* -d: no start-up file */
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
    const int trouble = posix_spawnp(pid, "gnuplot", &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (trouble == ENOENT)
        return wr_fail(err, "plots are drawn by the program gnuplot, which is not installed "
                            "(Debian's package gnuplot-nox)");
    return trouble == 0 || wr_fail(err, "gnuplot cannot be started: %s", strerror(trouble));
}

static bool wait_for(pid_t pid, int complaints, WrError *err)
{
    char words[300];
    int status;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
    const ssize_t n = pread(complaints, words, sizeof words - 1, 0);
    words[n > 0 ? n : 0] = '\0';
    for (char *c = words; *c; c++)
        if ((unsigned char)*c < ' ') *c = ' ';
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return true;
    return wr_fail(err, "gnuplot failed: %s", words[0] ? words : "it says nothing");
}

/* The drawing, in a file in memory. Everything goes through such files, so that neither side waits for the
   other. */
static int run(const WrText *script, WrError *err)
{
    pid_t pid;
    const int in = wr_fd_in_memory("plot", wr_text_get(script), script->length, err);
    if (in < 0) return -1;
    const int complaints = memfd_create("complaints", MFD_CLOEXEC);
    int drawing = memfd_create("drawing", MFD_CLOEXEC);
    bool good = (complaints >= 0 && drawing >= 0) ||
                wr_fail(err, "gnuplot cannot be started: %s", strerror(errno));
    good = good && spawn(in, drawing, complaints, &pid, err) && wait_for(pid, complaints, err);
    close(in);
    if (complaints >= 0) close(complaints);
    if (good || drawing < 0) return drawing;
    close(drawing);
    return -1;
}

/* gnuplot does not tell whether it could write all of it. */
static bool check_whole(const char *path, const char *bytes, size_t length, bool png, WrError *err)
{
    static const char end[] = "</svg>";
    if (!png) {
        const char *last = NULL;
        for (const char *p = bytes; (p = strstr(p, end)); p++) last = p;
        return last || wr_fail(err, "%s: gnuplot did not draw it to its end", path);
    }
    WrImage *image = wr_image_read_bytes(path, bytes, length, err);
    wr_image_free(image);
    return image != NULL;
}

static bool put_drawing(WrFileTarget *target, int drawing, bool png, WrError *err)
{
    char path[32], *bytes;
    size_t length;
    snprintf(path, sizeof path, "/proc/self/fd/%d", drawing);
    if (!wr_file_read(path, DRAWING_MAX, &bytes, &length, err)) return false;
    bool good = check_whole(target->path, bytes, length, png, err) &&
                wr_file_put(target, bytes, length, err);
    if (good) wr_file_verified(target);
    wr_free(bytes);
    return good;
}

bool wr_report_plot(const WrLadder *ladder, const char *name, const char *path, WrError *err)
{
    char ending[16];
    WrText script = { 0 };
    WrFileTarget target = { 0 };
    wr_path_ending(path, ending);
    const bool png = strcmp(ending, "png") == 0;
    if (!png && strcmp(ending, "svg") != 0)
        return wr_fail(err, "plot %s: the name must end in .png or .svg", path);
    if (!wr_file_begin(&target, path, err)) return false;
    wr_report_plot_script(ladder, name, png ? "pngcairo" : "svg", &script);
    const int drawing = run(&script, err);
    bool good = drawing >= 0 && put_drawing(&target, drawing, png, err);
    if (drawing >= 0) close(drawing);
    if (good) good = wr_file_commit(&target, err);
    else wr_file_abort(&target);
    wr_text_fini(&script);
    return good;
}
