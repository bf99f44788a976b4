#include "generate/generator.h"

const WrGenerator wr_text_rows[] = {
    { .family = NULL },
};
