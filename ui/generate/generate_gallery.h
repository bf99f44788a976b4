/* generate_gallery.h - small pictures of what all generators make, to choose one by: a list that opens from
   the Generate tab. They are made in the background, one after the other, while it is open. */
#pragma once
#include "ui/state/app_state.h"
#include "ui/state/roster.h"

typedef struct WrGallery WrGallery;

void wr_gallery_open(WrApp *app);
void wr_gallery_list(WrApp *app);   /* in the tab, each picture: the list, if it is open */
void wr_gallery_forget(WrApp *app); /* its pictures: they will be made again */
void wr_gallery_free(WrApp *app);

extern const WrPart wr_part_gallery;
