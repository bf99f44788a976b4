/* clip.h - pictures that other programs have put on the clipboard, which SDL does not give. */
#pragma once
#include <stdbool.h>
#include <stddef.h>

/* The bytes of a PNG file that the clipboard holds; the caller's (wr_free). False: it holds none, or its owner does not
 * answer within two seconds. */
bool wr_clip_picture(char **bytes, size_t *length);
