/* portal.h - asking for a file by the desktop's portal, org.freedesktop.portal.FileChooser on the session's D-Bus. libdbus
   is loaded when it is first needed (SDL has it with it on most systems); without it, or built without its headers, there is
   no portal. Knows nothing of the window; tested without one. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrPortalAsk {
    const char *title, *accept; /* of the dialog and of its button */
    const char *folder, *name;  /* where it begins; folder absolute, either may be "" */
    const char *parent;         /* the window that it belongs to, as in "x11:1a0000f"; "": none */
    const char *kind;           /* what the files are called that `endings` names */
    const char *all;            /* what all files are called */
    const char *const *endings; /* as in "png", NULL ends them; NULL: all files */
    bool save;                  /* a file to be written */
    double patience;            /* seconds until a portal has taken the question */
} WrPortalAsk;

typedef enum WrPortalEnd {
    WR_PORTAL_NONE, /* there is none, it did not answer in time, failed, or went away: ask another way */
    WR_PORTAL_CANCELLED,
    WR_PORTAL_CHOSE
} WrPortalEnd;

/* Could there be one? Quick; false: surely not. */
bool wr_portal_may_be(void);
/* Ask, and wait for the answer, which may take as long as the user does.
 *
 * stop     other than 0, set by any thread, closes the dialog: CANCELLED
 * path     [size]: the file, where one was chosen; the first of several
 * Threads  any; it keeps the calling one */
WrPortalEnd wr_portal_ask(const WrPortalAsk *ask, const volatile int *stop, char *path,
                          size_t size);

/* ---- portal_path.c ---- */

/* The path that a file's URI names. False: it is none of this machine's, not absolute, too long, or wrongly written. Bytes
 * that are no UTF-8 stay as they are. */
bool wr_portal_path(const char *uri, char *path, size_t size);
/* "png" as a pattern that matches it in capitals too: "*.[pP][nN][gG]". */
void wr_portal_pattern(const char *ending, char *pattern, size_t size);
