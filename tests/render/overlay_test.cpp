#include "render/overlay.h"
