/* portal.h - file dialog by the desktop portal, org.freedesktop.portal.FileChooser on the session's D-Bus. libdbus is
   loaded on first use (on most systems SDL loads it too). Without it, or in a build without its headers, there is no
   portal. Independent of the window; tested without one. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrPortalRequest {
    const char *title, *accept; /* titles of the dialog and of its button */
    const char *folder, *name;  /* initial place; folder absolute, either may be "" */
    const char *parent;         /* parent window, as in "x11:1a0000f"; "": none */
    const char *kind;           /* name of the file filter given by `endings` */
    const char *all;            /* name of the filter for all files */
    const char *const *endings; /* as in "png", NULL-terminated; NULL: all files */
    bool save;                  /* a file to be written */
    double patience;            /* timeout in seconds for the portal's first response */
} WrPortalRequest;

typedef enum WrPortalEnd {
    WR_PORTAL_NONE, /* none, no answer in time, failed, or lost: use another dialog */
    WR_PORTAL_CANCELLED,
    WR_PORTAL_CHOSE
} WrPortalEnd;

/* Fast check; false: certainly no portal. */
bool wr_portal_may_be(void);
/* Open the dialog and wait for the answer, however long the user needs.
 *
 * stop     non-zero, set by any thread, closes the dialog: CANCELLED
 * path     [size]: the chosen file; the first of several
 * Threads  any; blocks the calling one */
WrPortalEnd wr_portal_request(const WrPortalRequest *ask, const volatile int *stop, char *path,
                              size_t size);

/* ---- portal_path.c ---- */

/* Convert a file URI to a path. False: not on this machine, not absolute, too long, or malformed. Bytes that are not
 * UTF-8 are kept. */
bool wr_portal_path(const char *uri, char *path, size_t size);
/* "png" as a case-insensitive pattern: "*.[pP][nN][gG]". */
void wr_portal_pattern(const char *ending, char *pattern, size_t size);
