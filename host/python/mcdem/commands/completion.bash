# bash completion of mcdem, as `mcdem completion bash` writes it
_mcdem() {
    local current=${COMP_WORDS[COMP_CWORD]} line
    COMPREPLY=()
    while IFS= read -r line; do
        case $line in
        :files) compopt -o filenames; COMPREPLY+=($(compgen -f -- "$current")) ;;
        :folders) compopt -o filenames; COMPREPLY+=($(compgen -d -- "$current")) ;;
        *=) compopt -o nospace; COMPREPLY+=("$line") ;;
        *) COMPREPLY+=("${line%%$'\t'*}") ;;
        esac
    done < <("${COMP_WORDS[0]/#\~/$HOME}" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2> /dev/null)
}
complete -F _mcdem mcdem
