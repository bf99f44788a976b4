/* chosen_layers.h - the layers chosen in the layers' list, which its actions change together. The active layer is always
   one of them. Plain data; the document is not changed. */
#pragma once
#include "document/document.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrText WrText;

typedef struct WrChosenLayers {
    bool chosen[WR_LAYERS_MAX];
    int anchor;                   /* index of the layer at which a range begins */
    int count;                    /* layers of the document that was followed; 0: none yet */
    uint64_t name[WR_LAYERS_MAX]; /* hashes of their names: they identify layers that move */
    char *line;       /* the line after which `next` will be chosen, owned; NULL: none */
    uint64_t awaited; /* or the hash of the name of the layer that becomes active; 0: none */
    bool next[WR_LAYERS_MAX];
} WrChosenLayers;

/* Update it for the present document: layers that moved stay chosen, by their names, unless several have the same name;
   if the active layer is none of them, it becomes the only one. last_line: the newest command in force. Call it before the
   functions below. */
void wr_chosen_follow(WrChosenLayers *chosen, const WrDocument *document, const char *last_line);
void wr_chosen_free(WrChosenLayers *chosen); /* may be used again */

typedef enum WrChoosing {
    WR_CHOOSE_ONLY,   /* this layer alone */
    WR_CHOOSE_TOGGLE, /* add it; or remove it, unless it is the only one */
    WR_CHOOSE_RANGE   /* all from the anchor to it, and no others */
} WrChoosing;
/* Choose layer `index`. Returns the layer that must become active; until it is, it should be expected (below). */
int wr_chosen_pick(WrChosenLayers *chosen, int active, int index, WrChoosing how);
void wr_chosen_range(WrChosenLayers *chosen, int first, int last);
/* These layers will be chosen when layer `active` has become the active one. */
void wr_chosen_expect_active(WrChosenLayers *chosen, int active, const bool next[WR_LAYERS_MAX]);
/* These layers will be chosen when the line has become the newest command. */
void wr_chosen_expect(WrChosenLayers *chosen, const char *line, const bool next[WR_LAYERS_MAX]);

int wr_chosen_count(const WrChosenLayers *chosen);
int wr_chosen_highest(const WrChosenLayers *chosen); /* index; -1: none */
/* "2,4,5": these layers in a command line. */
void wr_layers_print(const bool layers[WR_LAYERS_MAX], WrText *text);
