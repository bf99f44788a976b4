/* api_internal.h - state of a document of the C interface. Private to this module. */
#pragma once
#include "api/wrinkle.h"
#include "base/error.h"
#include "base/progress.h"

#include <stdatomic.h>

typedef struct WrPool WrPool;
typedef struct WrSession WrSession;
typedef struct WrText WrText;

/* Threads of a document and its snapshots. */
typedef struct SharedPool {
    atomic_int refs;
    WrPool *pool;
} SharedPool;

struct WrDoc {
    WrSession *session;
    SharedPool *threads; /* NULL: those of the program */
    void (*note)(void *ctx, const char *text);
    bool (*report)(void *ctx, double fraction);
    void *ctx;
    volatile int cancel;
    WrProgress progress;
    char *scratch; /* folder of arrays that became files; NULL: none yet. Owned */
    int files;     /* in it */
};

/* A running function of the interface: the thread reports to the document's progress until its end. */
typedef struct ApiCall {
    WrDoc *doc;
    const WrProgress *outer;
    WrError err;
} ApiCall;
void wr_api_begin(ApiCall *call, const WrDoc *doc);
/* Restores the thread's progress and copies the error if not good. Returns good. */
bool wr_api_end(ApiCall *call, bool good, WrDocError *error);
/* Copies an error. */
void wr_api_error(WrDocError *error, int status, const char *text);
/* Writes the path of the document's folder for temporary files, which it makes at first use. */
bool wr_api_scratch(WrDoc *doc, WrText *path, WrError *err);
WrPool *wr_api_pool(const WrDoc *doc); /* may be NULL */
