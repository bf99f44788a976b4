/* File watching with inotify on the folders, because the watch of a file is lost when the file is
   replaced. */
#include "system/file_watch.h"

#include "system/path.h"

#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

#define WANTED (IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR)

typedef struct Mark {
    int folder; /* inotify's watch number */
    char name[NAME_MAX + 1];
} Mark;

struct WrWatch {
    int fd;
    int count, room;
    Mark *marks; /* each path and its link target */
};

static bool add(WrWatch *watch, const char *path)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const size_t length = !slash ? 0 : slash == path ? 1 : (size_t)(slash - path);
    if (length >= sizeof folder || strlen(name) > NAME_MAX) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (slash) memcpy(folder, path, length);
    folder[length] = '\0';
    if (watch->count == watch->room) {
        const int room = 2 * watch->room + 2;
        Mark *grown = realloc(watch->marks, (size_t)room * sizeof *grown);
        if (!grown) return false;
        watch->marks = grown;
        watch->room = room;
    }
    Mark *mark = &watch->marks[watch->count];
    strcpy(mark->name, name);
    mark->folder = inotify_add_watch(watch->fd, slash ? folder : ".", WANTED);
    if (mark->folder < 0) return false;
    for (int i = 0; i < watch->count; i++)
        if (watch->marks[i].folder == mark->folder && strcmp(watch->marks[i].name, name) == 0)
            return true;
    watch->count++;
    return true;
}

bool wr_watch_add(WrWatch *watch, const char *path)
{
    const bool good = add(watch, path);
    char *real = good ? wr_path_real(path) : NULL;
    if (real) add(watch, real);
    free(real);
    return good;
}

WrWatch *wr_watch_new(const char *path)
{
    WrWatch *watch = calloc(1, sizeof *watch);
    if (!watch) return NULL;
    watch->fd = inotify_init1(IN_CLOEXEC | IN_NONBLOCK);
    if (watch->fd >= 0 && wr_watch_add(watch, path)) return watch;
    const int why = errno;
    if (watch->fd >= 0) close(watch->fd);
    free(watch->marks);
    free(watch);
    errno = why;
    return NULL;
}

void wr_watch_free(WrWatch *watch)
{
    if (!watch) return;
    close(watch->fd);
    free(watch->marks);
    free(watch);
}

static WrWatchEnd judge(const WrWatch *watch, const struct inotify_event *event)
{
    if (event->mask & IN_Q_OVERFLOW) return WR_WATCH_CHANGED; /* possibly */
    for (int i = 0; i < watch->count; i++) {
        if (event->wd != watch->marks[i].folder) continue;
        if (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF)) return WR_WATCH_LOST;
        if (event->len > 0 && strcmp(event->name, watch->marks[i].name) == 0)
            return WR_WATCH_CHANGED;
    }
    return WR_WATCH_NOTHING;
}

/* Processes all pending events. */
static WrWatchEnd take(WrWatch *watch)
{
    _Alignas(struct inotify_event) char block[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)];
    WrWatchEnd end = WR_WATCH_NOTHING;
    for (ssize_t n; (n = read(watch->fd, block, sizeof block)) > 0;)
        for (ssize_t at = 0; at < n;) {
            const struct inotify_event *event = (const struct inotify_event *)(block + at);
            const WrWatchEnd one = judge(watch, event);
            if (one > end) end = one;
            at += (ssize_t)(sizeof *event + event->len);
        }
    return end;
}

WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds)
{
    const double ms = seconds * 1000.0;
    struct pollfd one = { .fd = watch->fd, .events = POLLIN };
    if (poll(&one, 1, ms < INT_MAX ? (int)ms + 1 : INT_MAX) <= 0) return WR_WATCH_NOTHING;
    return take(watch);
}
