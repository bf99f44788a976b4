#include "ui/app/state/search_words.h"

#include <stddef.h>

const WrSearchWords wr_search_words[] = {
    { "Smear", "smudge, finger, drag, wet brush" },
    { NULL, NULL },
};
