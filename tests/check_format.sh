#!/usr/bin/env bash
# Every C++ file is as clang-format (the version of Debian 12) leaves it.
set -euo pipefail
cd "$1"
git ls-files --cached --others --exclude-standard '*.h' '*.cpp' | while read -r file; do
    [ -e "$file" ] && printf '%s\0' "$file"
done | xargs -0 clang-format --dry-run -Werror
