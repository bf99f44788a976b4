/* The ffmpeg process: transfer of bytes in either direction, with cancellation at any time. */
#include "base/error.h"
#include "base/progress.h"
#include "export/film_internal.h"
#include "system/channel.h"
#include "system/clock.h"
#include "system/fd.h"
#include "system/thread.h"

#include <errno.h>
#include <string.h>

#define LOOK_MS 20 /* between two checks for cancellation */

bool wr_tool_start(WrTool *tool, const char *const *arguments, int out, double patience,
                   WrError *err)
{
    int ends[2] = { -1, -1 };
    *tool = (WrTool){ .channel = -1, .complaints = wr_fd_memory("complaints") };
    if (tool->complaints < 0 || !wr_channel_pair(ends, false)) {
        wr_fail(err, "ffmpeg cannot be started: %s", strerror(errno));
        wr_tool_drop(tool);
        return false;
    }
    const bool gives = out < 0;
    const int nowhere = gives ? wr_fd_open_nowhere() : -1;
    const WrChildStart it = { .program = "ffmpeg",
                              .arguments = arguments,
                              .in = gives ? nowhere : ends[1],
                              .out = gives ? ends[1] : out,
                              .err = tool->complaints,
                              .search = true,
                              .bound = true };
    const int trouble = wr_child_start(&it, &tool->child);
    wr_fd_close(ends[1]);
    if (nowhere >= 0) wr_fd_close(nowhere);
    tool->channel = ends[0];
    tool->patience = patience;
    tool->since = wr_clock_seconds();
    if (trouble == 0) return true;
    tool->child = 0;
    wr_tool_drop(tool);
    if (trouble == ENOENT)
        return wr_fail(err,
                       "films are made by the program ffmpeg, which is not installed (Debian's "
                       "package ffmpeg)");
    return wr_fail(err, "ffmpeg cannot be started: %s", strerror(trouble));
}

/* True if waiting may continue. Otherwise the process is ended. */
static bool waits(WrTool *tool, WrError *err)
{
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (wr_clock_seconds() - tool->since < tool->patience) return true;
    return wr_fail(err, "ffmpeg hangs: it did nothing for %g seconds", tool->patience);
}

static bool has_ended(WrTool *tool)
{
    if (!tool->ended && tool->child > 0) tool->ended = wr_child_ended(tool->child, &tool->end);
    return tool->ended;
}

/* Waits for its end. */
static bool wait_for_end(WrTool *tool, WrError *err)
{
    for (int ms = 1; !has_ended(tool); ms = ms < LOOK_MS ? 2 * ms : LOOK_MS) {
        if (!waits(tool, err)) return false;
        wr_thread_sleep_ms(ms);
    }
    return true;
}

/* Its last error message, in one line. */
static void complaint(const WrTool *tool, char words[WR_FILE_WHY])
{
    char text[2048], *line = text;
    const int64_t n = wr_fd_read_at(tool->complaints, text, sizeof text - 1, 0);
    text[n > 0 ? n : 0] = '\0';
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 127) *c = ' ';
    line += strspn(line, " ");
    for (size_t length = strlen(line); length > 0 && line[length - 1] == ' ';) line[--length] = 0;
    char why[WR_FILE_WHY];
    snprintf(words, WR_FILE_WHY, "%s", wr_file_why_of_library(line, why));
}

static bool fail_end(const WrTool *tool, WrError *err)
{
    char words[WR_FILE_WHY];
    const char *crash = tool->end.why == WR_CHILD_CRASHED ? wr_child_crash(tool->end.number) : NULL;
    complaint(tool, words);
    if (words[0]) return wr_fail(err, "ffmpeg failed: %s", words);
    if (tool->end.why == WR_CHILD_KILLED)
        return wr_fail(err, "ffmpeg was killed, by somebody or for want of memory");
    if (tool->end.why == WR_CHILD_LEFT)
        return wr_fail(err, "ffmpeg failed with status %d and does not say why", tool->end.number);
    return wr_fail(err, "ffmpeg crashed (%s)", crash ? crash : "at its limit of time");
}

bool wr_tool_put(WrTool *tool, const void *bytes, size_t length, WrError *err)
{
    const char *at = bytes;
    while (length > 0) {
        const int64_t n = wr_channel_put(tool->channel, at, length);
        if (n < 0) {
            if (!wait_for_end(tool, err)) return false;
            return fail_end(tool, err);
        }
        if (n > 0) {
            tool->since = wr_clock_seconds();
            at += n;
            length -= (size_t)n;
        } else if (!wr_channel_wait_room(tool->channel, LOOK_MS) && !waits(tool, err)) {
            return false;
        }
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    }
    return true;
}

bool wr_tool_get(WrTool *tool, void *bytes, size_t length, size_t *got, WrError *err)
{
    char *at = bytes;
    *got = 0;
    while (*got < length) {
        if (wr_channel_wait(tool->channel, LOOK_MS) != WR_CHANNEL_NEWS) {
            if (!waits(tool, err)) return false;
            continue;
        }
        const int64_t n = wr_channel_receive(tool->channel, at + *got, length - *got, NULL, 0);
        if (n == 0 || n == -1) break;
        if (n > 0) *got += (size_t)n;
        tool->since = wr_clock_seconds();
        if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    }
    return true;
}

bool wr_tool_finish(WrTool *tool, WrError *err)
{
    wr_channel_end(tool->channel);
    tool->since = wr_clock_seconds();
    if (!wait_for_end(tool, err)) return false;
    if (tool->end.why == WR_CHILD_LEFT && tool->end.number == 0) return true;
    return fail_end(tool, err);
}

void wr_tool_drop(WrTool *tool)
{
    if (tool->child > 0 && !has_ended(tool)) {
        wr_child_kill(tool->child);
        wr_child_wait(tool->child, &tool->end);
    }
    tool->child = 0;
    if (tool->channel >= 0) wr_fd_close(tool->channel);
    if (tool->complaints >= 0) wr_fd_close(tool->complaints);
    tool->channel = tool->complaints = -1;
}
