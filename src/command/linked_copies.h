/* linked_copies.h - linked copies: generator layers whose line is `link LAYER`. For generator_layers.c and the
   commands of layers. Private to src/command, except wr_line_links. */
#pragma once
#include "base/hash.h"
#include "document/document.h"

#include <stdbool.h>

typedef struct WrCall WrCall;
typedef struct WrSession WrSession;

/* Of each layer: whether its line copies a layer, and the index of that; -1: none, or it is gone. */
typedef struct WrLinks {
    bool any;
    bool copies[WR_LAYERS_MAX];
    int source[WR_LAYERS_MAX];
    bool within[WR_LAYERS_MAX]; /* in a group that is copied, and visible up to that */
} WrLinks;

/* Layers that the heights of one depend on: one layer (-1: none), and the composite of rows from..to - 1. */
typedef struct WrReads {
    int layer, from, to;
} WrReads;

/* True if that line of a generator layer makes a linked copy; NULL: false. */
bool wr_line_links(const char *line);
/* Makes it the line of the layer to copy the layer of that name; its content stays as it is. */
void wr_layer_link(WrLayer *layer, const char *source);
void wr_session_links(const WrSession *session, WrLinks *links);
/* True if the layer is shown, or a copy shows it: its line is generated again when layers that it reads change. */
bool wr_layer_is_followed(const WrDocument *document, const WrLinks *links, int index);
/* The source of a copy, the members of a group, or the layers below that another line reads. */
WrReads wr_session_reads(const WrSession *session, const WrLinks *links, int index);

/* Replace the layer's number in a call of `link` by its name. The copy is, or will be, between the layers below `place` and
   those from `above` on. Another call is left as it is. Error: no such layer, the copy itself, a filter, or a name that
   stands for another layer. */
bool wr_session_name_source(const WrSession *session, int place, int above, WrCall *call,
                            WrError *err);
/* Replace the number in the call of a copy that is about to be made at layer `index`, as wr_session_name_source does. *read:
   output, content hash of its source. Error: also a cycle. */
bool wr_session_take_source(WrSession *session, int index, WrCall *call, WrHash *read,
                            WrError *err);
/* Hash of a layer's own heights and coverage. */
WrHash wr_layer_content_hash(const WrLayer *layer);
/* Record that the layer's copy, if it is one, was made of its source as it is. */
void wr_session_note_source(WrSession *session, int index);

/* True if the copy has a source and is in no cycle; else it keeps its heights, with a note the first time. */
bool wr_session_check_source(WrSession *session, const WrLinks *links, int index);
/* True if the source has changed since the copy was made. The copy must have one. */
bool wr_session_link_lags(WrSession *session, const WrLinks *links, int index);
/* After opening: note a copy without source. */
void wr_session_note_link(WrSession *session, int index);

/* The line of layer `of` (one that it has, or had) with another name for layer `index`; NULL: it does not copy that layer.
   The caller frees it. Before the layer is renamed. */
char *wr_link_renamed(const WrDocument *document, int of, const char *line, int index,
                      const char *name);
/* Layer `index` is about to get another name: the lines of its copies get it too. */
void wr_session_rename_in_links(WrSession *session, int index, const char *name);
