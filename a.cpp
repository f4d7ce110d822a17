#include <OpenImageIO/parallel.h>
