/* image_info.h - parser of an image file's label (WrImageLabel, image.h).
   Private to this module. */
#pragma once
#include "image/image.h"

/* The text of that name, or NULL. */
typedef const char *WrLabelText(const void *from, const char *name);
void wr_image_label_read(WrLabelText *text, const void *from, WrPixelType type,
                         WrImageLabel *label);
