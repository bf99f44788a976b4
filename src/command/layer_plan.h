/* layer_plan.h - plan of a document's layers: those that the picture needs, those made at the last command, and their
   costs. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

typedef struct WrDocument WrDocument;
typedef struct WrSession WrSession;

/* Why a layer is needed or not. */
typedef enum WrLayerWhy {
    WR_LAYER_NEEDED,
    WR_LAYER_HIDDEN,
    WR_LAYER_CLEAR,  /* opacity 0 */
    WR_LAYER_ALONE,  /* another layer is shown alone */
    WR_LAYER_COVERED /* a layer above hides it in every texel */
} WrLayerWhy;

typedef struct WrLayerNeed {
    WrLayerWhy why;
    int by; /* index of the layer that is alone or covers it; -1: none */
} WrLayerNeed;

/* Result of the last command for a layer. */
typedef enum WrLayerRun {
    WR_LAYER_EVALUATED, /* made again */
    WR_LAYER_REUSED,    /* nothing that it depends on has changed */
    WR_LAYER_SKIPPED    /* not needed; it may be out of date, and is made when it is needed again */
} WrLayerRun;
extern const char *const wr_layer_runs[]; /* "evaluated", ... */

typedef struct WrLayerPlan {
    /* "filter", "generator", "group", each also with ", live mask"; "live mask" or "plain" */
    const char *kind;
    WrLayerRun run;
    char reason[80];   /* English */
    char message[160]; /* the reason as a message (base/message.h), for translation */
    double
        seconds; /* of the last making of its heights and its mask in this process; 0: not made yet */
    size_t tiles,
        bytes; /* of its heights, coverage and mask, or a filter's result, that no other layer shares */
} WrLayerPlan;

/* The plan of each layer after the last command. plan: [layer_count] */
void wr_session_layer_plan(const WrSession *session, WrLayerPlan *plan);
