/* file_watch.h - notification of file changes, without polling where the system supports it.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>

typedef struct WrWatch WrWatch;

/* Watches a path, and its target if it is a link. The file may be written, replaced, or missing for a
   while. Its folder must exist. NULL: errno has the reason. */
WrWatch *wr_watch_new(const char *path);
void wr_watch_free(WrWatch *watch); /* NULL is allowed */
/* Adds another path; any number. False: errno has the reason, and the others are still watched. */
bool wr_watch_add(WrWatch *watch, const char *path);

typedef enum WrWatchEnd {
    WR_WATCH_NOTHING, /* timeout or interrupt */
    WR_WATCH_REPLACED, /* another file was renamed to one of the paths, and is complete; the content may be equal */
    WR_WATCH_CHANGED, /* a writer has closed one of the files; the content may be equal, or incomplete */
    WR_WATCH_LOST /* a folder was removed */
} WrWatchEnd;
/* Sleeps until a change, `seconds` at most. */
WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds);
