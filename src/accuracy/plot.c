/* Plot of error against time as a picture, drawn by gnuplot. */
#include "accuracy/report.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"
#include "system/child.h"
#include "system/fd.h"
#include "system/process.h"

#include <errno.h>
#include <string.h>

#define DRAWING_MAX ((size_t)256 << 20) /* bytes */

/* Starts gnuplot with open files as input, output and error output. */
static bool spawn(int in, int out, int complaints, WrPid *pid, WrError *err)
{
    const char *const arguments[] = { "gnuplot", "-d", "-", NULL }; /* -d: no start-up file */
    const WrChildStart it = { .program = "gnuplot",
                              .arguments = arguments,
                              .in = in,
                              .out = out,
                              .err = complaints,
                              .search = true };
    const int trouble = wr_child_start(&it, pid);
    if (trouble == ENOENT)
        return wr_fail(err, "plots are drawn by the program gnuplot, which is not installed "
                            "(Debian's package gnuplot-nox)");
    return trouble == 0 || wr_fail(err, "gnuplot cannot be started: %s", strerror(trouble));
}

static bool wait_for(WrPid pid, int complaints, WrError *err)
{
    char words[300];
    WrChildEnd end;
    wr_child_wait(pid, &end);
    const int64_t n = wr_fd_read_at(complaints, words, sizeof words - 1, 0);
    words[n > 0 ? n : 0] = '\0';
    for (char *c = words; *c; c++)
        if ((unsigned char)*c < ' ') *c = ' ';
    if (end.why == WR_CHILD_LEFT && end.number == 0) return true;
    return wr_fail(err, "gnuplot failed: %s", words[0] ? words : "it says nothing");
}

/* Draws to a file in memory. Input and output are such files, so that neither process waits for the other. */
static int run(const WrText *script, WrError *err)
{
    WrPid pid;
    const int in = wr_fd_in_memory("plot", wr_text_get(script), script->length, err);
    if (in < 0) return -1;
    const int complaints = wr_fd_memory("complaints");
    int drawing = wr_fd_memory("drawing");
    bool good = (complaints >= 0 && drawing >= 0) ||
                wr_fail(err, "gnuplot cannot be started: %s", strerror(errno));
    good = good && spawn(in, drawing, complaints, &pid, err) && wait_for(pid, complaints, err);
    wr_fd_close(in);
    if (complaints >= 0) wr_fd_close(complaints);
    if (good || drawing < 0) return drawing;
    wr_fd_close(drawing);
    return -1;
}

/* gnuplot does not report incomplete output. */
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
    char path[WR_FD_NAME], *bytes;
    size_t length;
    wr_fd_name(drawing, path);
    if (wr_fd_seek(drawing, 0) != 0 || !wr_file_read(path, DRAWING_MAX, &bytes, &length, err))
        return false;
    bool good = check_whole(target->path, bytes, length, png, err) &&
                wr_file_put(target, bytes, length, err);
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
    if (drawing >= 0) wr_fd_close(drawing);
    if (good) good = wr_file_commit(&target, err);
    else wr_file_abort(&target);
    wr_text_fini(&script);
    return good;
}
