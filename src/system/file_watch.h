/* file_watch.h - being told that a file was changed, while nothing is asked meanwhile where the system tells.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>

typedef struct WrWatch WrWatch;

/* Watch what stands under that name, and behind it where it is a link: it may be written, or replaced by another file,
   or be gone for a while. Its folder must be there. NULL: errno says why not. */
WrWatch *wr_watch_new(const char *path);
void wr_watch_free(WrWatch *watch); /* NULL is fine */
/* Another name as well, of which there may be many. False: errno says why not, and the others are still watched. */
bool wr_watch_add(WrWatch *watch, const char *path);

typedef enum WrWatchEnd {
    WR_WATCH_NOTHING, /* so long; or an interrupt came */
    WR_WATCH_CHANGED, /* somebody who wrote to one of them is done, or another file came: perhaps with the same in it */
    WR_WATCH_LOST /* a folder is gone */
} WrWatchEnd;
/* Sleep until then, `seconds` at most. */
WrWatchEnd wr_watch_wait(WrWatch *watch, double seconds);
