#include "base/error.h"

namespace relevo {

void bad_input(const std::string& message) {
    throw Error(ErrorCode::BadInput, message);
}

void bad_usage(const std::string& message) {
    throw Error(ErrorCode::Usage, message);
}

void failed(const std::string& message) {
    throw Error(ErrorCode::Failed, message);
}

}  // namespace relevo
