#include "base/error.h"

#include "base/text.h"

namespace relevo {

void bad_input(const std::string& message) {
    throw Error(ErrorCode::BadInput, printable(message));
}

void bad_usage(const std::string& message) {
    throw Error(ErrorCode::Usage, printable(message));
}

void failed(const std::string& message) {
    throw Error(ErrorCode::Failed, message);
}

}  // namespace relevo
