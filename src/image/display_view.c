#include "image/display_view.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "image/oiio.h"
#include "system/thread.h"

#include <stdlib.h>
#include <string.h>

/* A view stays in the list, since any scene may hold it: a changed file makes a new one. */
typedef struct Loaded {
    WrDisplayView view; /* first: a pointer to it is one to the whole */
    WrFileIdentity file;
    const WrCodec *library;
    WrCodecView *transform; /* NULL: not ready */
    struct Loaded *next;
} Loaded;

static Loaded *list;
static WrMutex lock = WR_MUTEX_READY;

static bool same(const WrDisplayViewNames *a, const WrDisplayViewNames *b)
{
    return strcmp(a->config, b->config) == 0 && strcmp(a->display, b->display) == 0 &&
           strcmp(a->view, b->view) == 0 && strcmp(a->space, b->space) == 0;
}

static Loaded *find(const WrDisplayViewNames *names, bool ready, const WrFileIdentity *file)
{
    for (Loaded *at = list; at; at = at->next)
        if (at->view.ready == ready && same(&at->view.names, names) &&
            wr_file_identity_same(&at->file, file))
            return at;
    return NULL;
}

static Loaded *add(const WrDisplayViewNames *names, const WrFileIdentity *file)
{
    Loaded *made = wr_alloc(1, sizeof *made);
    *made = (Loaded){ .view.names = { wr_strdup(names->config), wr_strdup(names->display),
                                      wr_strdup(names->view), wr_strdup(names->space) },
                      .file = *file,
                      .next = list };
    list = made;
    return made;
}

static const WrDisplayView *load(const WrDisplayViewNames *names, const char *path, WrError *err)
{
    char reason[WR_CODEC_REASON] = "";
    const WrFileIdentity file = wr_file_identity(path);
    Loaded *old = find(names, true, &file);
    if (old) return &old->view;
    const WrCodec *library = wr_oiio(err);
    if (!library) return NULL;
    WrCodecView *transform = library->view(path, names->display, names->view, names->space, reason);
    if (!transform) {
        wr_fail(err, "%s: %s", path, reason);
        return NULL;
    }
    Loaded *made = add(names, &file);
    made->library = library;
    made->transform = transform;
    made->view.ready = true;
    return &made->view;
}

const WrDisplayView *wr_display_view_load(const WrDisplayViewNames *names, WrError *err)
{
    const char *own = getenv("OCIO"), *path = *names->config ? names->config : own;
    if (!path || !*path) {
        wr_fail(err, "view=%s needs a colour configuration: set $OCIO, or add ocio=FILE",
                names->view);
        return NULL;
    }
    if (!wr_file_identity(path).there) {
        if (*names->config) wr_fail(err, "%s: no such file: correct ocio=", path);
        else wr_fail(err, "%s: no such file: correct $OCIO, or add ocio=FILE", path);
        return NULL;
    }
    wr_mutex_lock(&lock);
    const WrDisplayView *view = load(names, path, err);
    wr_mutex_unlock(&lock);
    return view;
}

const WrDisplayView *wr_display_view_named(const WrDisplayViewNames *names)
{
    const WrFileIdentity none = { .there = false };
    wr_mutex_lock(&lock);
    Loaded *found = find(names, false, &none);
    if (!found) found = add(names, &none);
    wr_mutex_unlock(&lock);
    return &found->view;
}

void wr_display_view_apply(const WrDisplayView *view, float *rgb, int count)
{
    const Loaded *loaded = (const Loaded *)view;
    loaded->library->view_apply(loaded->transform, rgb, count);
}
