/* folds.h - remembered states of foldable headings that differ from their first state. Plain data. */
#pragma once
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

#define WR_FOLDS_MAX 160

/* A list of "+NAME" for an opened heading and "-NAME" for a closed one, oldest first, NULL-terminated; its owner is the
   caller. */
bool wr_folds_is_open(char *const folds[WR_FOLDS_MAX], const char *name, bool open_at_first);
/* A full list forgets its oldest entry. */
void wr_folds_set(char *folds[WR_FOLDS_MAX], const char *name, bool open_at_first, bool open);

#ifdef __cplusplus
}
#endif
