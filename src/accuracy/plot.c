/* Error against time as a picture: gnuplot draws it. */
#include "accuracy/report.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#define DRAWING_MAX ((size_t)256 << 20) /* bytes */

extern char **environ;

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
