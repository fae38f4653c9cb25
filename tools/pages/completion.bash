# The rest is the same for every table. _pirouette_takes and _pirouette_value are above, as is _pirouette_subcommands.

# Puts into COMPREPLY those of the words $2 that begin with $1.
_pirouette_reply() { mapfile -t COMPREPLY < <(compgen -W "$2" -- "$1"); }

# The names of built-in models, from the command itself, with $1 before each.
_pirouette_shapes() { "${COMP_WORDS[0]}" shape --list 2>/dev/null | sed "s/ .*//; s/^/$1/"; }

# Where `shape:` may still follow it stands beside the files. Where it cannot, bash completes files by itself.
_pirouette_model() {
    local name
    [[ shape: == "$1"* ]] || return
    while IFS= read -r name; do
        if [[ -d $name ]]; then name+=/; fi
        COMPREPLY+=("$(printf '%q' "$name")")
    done < <(compgen -f -- "$1")
    COMPREPLY+=(shape:)
    compopt -o nospace
}

# What begins with $1 and is of the kind $2. Where COMPREPLY stays empty bash completes files, unless told not to.
_pirouette_kind() {
    case $2 in
    file) return ;;
    model)
        if [[ $1 != shape:* ]]; then
            _pirouette_model "$1"
            return
        fi
        _pirouette_reply "$1" "$(_pirouette_shapes shape:)"
        ;;
    folder)
        mapfile -t COMPREPLY < <(compgen -d -S / -- "$1")
        compopt -o nospace
        ;;
    shape) _pirouette_reply "$1" "$(_pirouette_shapes '')" ;;
    subcommand) _pirouette_reply "$1" "$_pirouette_subcommands" ;;
    words*) _pirouette_reply "$1" "${2#words }" ;;
    text) ;;
    esac
    compopt +o default
}

_pirouette() {
    local line=${COMP_LINE:0:COMP_POINT} words word i
    local subcommand='' options arguments option='' value='' ended='' count=0
    COMPREPLY=()

    # Words end at blanks alone, not also where COMP_WORDBREAKS says.
    read -ra words <<<"$line"
    [[ $line != *[[:blank:]] ]] || words+=('')
    word=${words[-1]}

    # What stands before the word: the subcommand, a count of its arguments, an option that waits for its value.
    _pirouette_takes ''
    for ((i = 1; i < ${#words[@]} - 1; i++)); do
        if [[ $value ]]; then
            value=
        elif [[ ! $ended && ${words[i]} == -- ]]; then
            ended=1
        elif [[ ! $ended && ${words[i]} == -?* ]]; then
            _pirouette_value "$subcommand" "${words[i]}"
        elif [[ ! $subcommand ]]; then
            subcommand=${words[i]}
            _pirouette_takes "$subcommand"
        else
            count=$((count + 1))
        fi
    done

    if [[ $value ]]; then
        _pirouette_kind "$word" "$value"
    elif [[ ! $ended && $word == -*=* ]]; then
        option=${word%%=*}=
        _pirouette_value "$subcommand" "${option%=}"
        _pirouette_kind "${word#*=}" "${value:-text}"
    elif [[ ! $ended && $word == -* ]]; then
        _pirouette_kind "$word" "words ${options[*]}"
    elif [[ ! $subcommand ]]; then
        _pirouette_kind "$word" subcommand
    else
        _pirouette_kind "$word" "${arguments[count]:-text}"
    fi

    # Bash replaces only what follows the last of its own breaks, which `=` and `:` are unless somebody took them away.
    local whole=$word
    [[ $COMP_WORDBREAKS == *=* ]] || whole=${whole//=/-}
    [[ $COMP_WORDBREAKS == *:* ]] || whole=${whole//:/-}
    whole=${whole##*[=:]}
    local kept=${word:0:${#word}-${#whole}}
    [[ ${#COMPREPLY[@]} -eq 0 ]] || COMPREPLY=("${COMPREPLY[@]/#/$option}")
    [[ ${#COMPREPLY[@]} -eq 0 ]] || COMPREPLY=("${COMPREPLY[@]#"$kept"}")
}

complete -o default -F _pirouette pirouette
