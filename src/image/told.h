/* told.h - reading the label of a file (WrImageLabel, image.h).
   Private to this room. */
#pragma once
#include "image/image.h"

void wr_image_label_read(WrImageFile *file, int part, WrPixelType type, WrImageLabel *label);
